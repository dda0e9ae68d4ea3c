"""Train the surrogates, from the root of a checkout: ``python -m research.training``.

It needs JAX and pyarrow, ``pip install -e '.[research]'``. ``rows`` reads the data sets,
``fitting`` fits a network, ``shop`` many in processes, ``refining`` those of what is left over;
``train_sphere``, ``train_solids``, ``train_punch`` and ``train_short_range`` train the surrogate of
a contact, ``make`` writes any of them; ``second`` adds the networks that must agree;
``calibration`` measures intervals, ``scores`` errors. The package evaluates surrogates and
imports nothing from here.
"""
