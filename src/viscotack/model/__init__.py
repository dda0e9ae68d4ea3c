"""What a problem consists of: solids, laws, shapes, bodies and tests, and the problem itself."""
