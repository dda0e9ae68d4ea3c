"""Learned answers: what was learned from simulations, how, and what it is worth.

``table`` reads rows of detachments, ``features`` turns them into what is learned from,
``learners`` holds the kinds of model, and the modules that begin with ``study`` repeat the
comparison of Maghami, PhD thesis (2025), chapter 5, on any such table. Nothing here is imported by
``import viscotack``; scikit-learn and xgboost come with ``pip install 'viscotack[learn]'``.
"""
