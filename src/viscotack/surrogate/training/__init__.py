"""How a surrogate is made: ``python -m viscotack.surrogate``, ``pip install 'viscotack[train]'``.

``rows`` come from the datasets, ``fitting`` fits a network, ``shop`` many; ``recipe`` says which
network learns what, ``calibration`` measures intervals, ``scores`` what a surrogate is worth;
``make`` does all of it, and ``choosing`` says what to simulate next.
"""
