"""Files: written whole or not at all, tables of quantities, and one writer at a time."""
