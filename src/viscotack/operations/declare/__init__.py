"""Declaration of operations: cards of options, answers, and conversion from and to text."""
