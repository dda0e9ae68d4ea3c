"""Options, inputs and records shared by several operations."""
