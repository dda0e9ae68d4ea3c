"""The learning study of Maghami, PhD thesis (2025), chapter 5, done again and judged.

``python -m research.replication.learning --table FILE --out DIR``. ``features`` has the inputs,
``learners`` by what, ``splits`` what is held out, ``validation`` how it is scored; ``thesis`` holds
what the thesis reports. ``study`` puts the parts together: ``tables``, ``noise``, ``tuning``,
``insight``, ``extrapolation``, ``trajectories``; ``report`` writes its ``sheets`` and ``figures``.
"""
