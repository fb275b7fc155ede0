"""Play in random four-bar linkages against pins at random in their holes."""
