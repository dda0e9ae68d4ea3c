"""Data sets of simulated detachments as Parquet files, and the plans that they were made from.

``viscotack.datasets.load`` finds them, verifies their checksums and returns tables.
"""
