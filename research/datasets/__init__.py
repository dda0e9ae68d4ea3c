"""How the data sets of :mod:`viscotack.datasets` are made: a campaign each, run again finer."""
