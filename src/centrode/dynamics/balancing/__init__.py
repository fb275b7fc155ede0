"""What a mechanism's inertia does to its frame, and counterweights that take it away."""
