"""How a surrogate is made: ``python -m viscotack.surrogate``, ``pip install 'viscotack[train]'``.

``rows`` come from the datasets, ``fitting`` fits a network, ``shop`` many; ``recipe`` says which
network learns what, ``refining`` looks twice, ``calibration`` measures intervals, ``scores`` what a
surrogate is worth; ``make`` does all of it. ``train_solids``, ``train_punch`` and ``short_range``
make those of the other contacts.
"""
