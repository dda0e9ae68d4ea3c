"""Options, inputs and records that several operations have."""
