"""The ledger: each claim of the thesis beside what is measured here, and a verdict.

A claim is a row of claims.toml, and names the function that measures it, from theory or from the
kept numbers of figures. ``python -m research.replication ledger --write`` writes
out/replication/ledger.md and docs/replication.md, its summary; ``claim NAME --afresh`` measures one
again from nothing.
"""
