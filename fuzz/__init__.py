"""A metamorphic fuzzer: random problems, and relations between answers that need no reference.

``python -m fuzz --seed 7 --minutes 25`` from the root of a checkout. Each check draws a relation
and a case, builds a partner whose answer follows from that of the case, and compares both. A failed
check is shrunk to a simple case and printed as one command that repeats it.
"""
