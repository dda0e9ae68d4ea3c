"""How an operation is declared: cards of its options, its answer, and their readings as text."""
