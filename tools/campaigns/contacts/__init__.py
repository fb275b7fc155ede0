"""Random mechanisms with stops and dry friction against time steps that seek no event."""
