"""Learned answers: what was learned from simulations, how, and what it is worth.

The surrogate that is shipped: ``physics`` has what is known without learning, ``network`` and
``line`` what is said with it, ``model`` puts them together, ``trust`` says how sure it is,
``store`` reads and writes files, ``onnx_export`` hands it to other programs. It is made by
``python -m viscotack.surrogate``: ``rows`` come from the datasets, ``fitting`` fits a network,
``shop`` many, ``training`` a surrogate, ``calibration`` measures its intervals, ``scores`` what it
is worth, ``choosing`` says what to simulate next; that needs ``pip install 'viscotack[train]'``.

``table`` reads rows of detachments, ``features`` turns them into what is learned from,
``learners`` holds the kinds of model, and the modules that begin with ``study`` repeat the
comparison of Maghami, PhD thesis (2025), chapter 5, on any such table; scikit-learn and xgboost
come with ``pip install 'viscotack[learn]'``. Nothing here is imported by ``import viscotack``.
"""
