"""The table of detachments that the thesis's authors published, put beside the simulation.

``python -m research.replication.published --table FILE``. ``compare`` simulates every row, ``page``
and ``draw`` write what came out.
"""
