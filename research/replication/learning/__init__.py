"""What the models of chapter 5 of the thesis learn from, by what, and how it is scored."""
