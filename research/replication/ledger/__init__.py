"""The ledger: each claim of the thesis beside what is measured here, and a verdict.

A claim is a small object with a function that measures it, from theory or from the kept numbers of
figures. ``python -m research.replication ledger --write`` writes docs/replication.md; ``python -m
replication claim NAME --afresh`` measures one again from nothing.
"""
