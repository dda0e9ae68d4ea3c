"""Train the surrogates of the package, from the root of a checkout: ``python -m training``.

It needs JAX and pyarrow, ``pip install -e '.[train]'``. ``rows`` reads the data sets, ``fitting``
fits a network, ``shop`` many in processes; ``recipe`` defines what each network learns,
``refining`` fits residuals, ``calibration`` measures intervals, ``scores`` errors; ``make`` runs
all of them for spheres on power laws. ``train_solids``, ``train_punch`` and ``short_range`` train
the surrogates of the other contacts. ``viscotack.surrogate`` evaluates them and imports nothing
from here.
"""
