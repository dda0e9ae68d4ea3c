"""What the thesis reports of its models: Tables 5.1 to 5.4 and A.1, to compare with.

Source: Maghami, PhD thesis (2025), chapter 5 and appendices VII and X. Mean square errors are of
the log10, in 1e-3; means and standard deviations over five folds of 8505 rows.
"""

from typing import NamedTuple

from .features import Target

# Training time of XGBoost for Table 5.1 in the authors' log, RPML_model_comparison_table.txt [s].
LOGGED_TIME = 0.1125
# Where boosting stopped (appendix X), on 15 % of the rows held out.
STOPPED_AT = 689


class Entry(NamedTuple):
    """A row of a table of the thesis: mean and spread of MSE [1e-3], and mean of R2."""

    mse: float
    mse_spread: float
    r2: float


class Table(NamedTuple):
    """A table of the thesis: what was learned, whether with the descriptor, and how well."""

    target: Target
    descriptor: bool
    entries: dict[str, Entry]


TABLES = {
    "5.1": Table(
        Target.FORCE,
        False,
        {
            "Linear Regression": Entry(19.1948, 0.7166, 0.8384),
            "Regression Tree": Entry(0.3502, 0.0996, 0.9970),
            "Random Forest": Entry(0.2155, 0.0874, 0.9982),
            "XGBoost": Entry(0.1449, 0.0411, 0.9988),
        },
    ),
    "5.2": Table(
        Target.FORCE,
        True,
        {
            "Linear Regression": Entry(16.7658, 1.0776, 0.8586),
            "Regression Tree": Entry(0.1355, 0.0796, 0.9989),
            "XGBoost": Entry(0.0977, 0.0824, 0.9992),
            "Random Forest": Entry(0.0575, 0.0247, 0.9995),
        },
    ),
    "5.3": Table(
        Target.WORK,
        False,
        {
            "Linear Regression": Entry(51.4637, 12.5943, 0.9062),
            "Regression Tree": Entry(4.6163, 2.0924, 0.9916),
            "XGBoost": Entry(3.1094, 1.8688, 0.9943),
            "Random Forest": Entry(2.9948, 1.3544, 0.9945),
        },
    ),
    "5.4": Table(
        Target.WORK,
        True,
        {
            "Linear Regression": Entry(51.1512, 12.5556, 0.9067),
            "Regression Tree": Entry(4.0330, 2.0619, 0.9926),
            "XGBoost": Entry(2.9248, 1.8478, 0.9946),
            "Random Forest": Entry(2.4197, 1.2864, 0.9956),
        },
    ),
}

# Table A.1: mean, median, standard deviation, least, greatest.
STATISTICS = {
    "log10 preload": (0.5718, 0.684, 0.9359, -2.255, 2.738),
    "tabor": (0.7181, 0.3, 0.9501, 0.04, 3.24),
    "log10 rate": (4.467, 4.4, 2.75, -1.5, 10),
    "log10 modulus ratio": (-0.9189, -1, 0.219, -4, -0.301),
    "exponent": (0.8471, 0.6, 0.5635, 0.2, 2),
}
