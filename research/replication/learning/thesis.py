"""What the thesis reports of its models, to compare with: thesis.toml says of what."""

import tomllib
from pathlib import Path
from typing import NamedTuple

from .features import Target

# Training time of XGBoost for Table 5.1 in the authors' log, RPML_model_comparison_table.txt [s].
LOGGED_TIME = 0.1125
# Where boosting stopped (appendix X), on 15 % of the rows held out.
STOPPED_AT = 689
_PRINTED = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))


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
    number: Table(
        Target(row["target"]),
        row["descriptor"],
        {name: Entry(*numbers) for name, numbers in row["entries"].items()},
    )
    for number, row in _PRINTED["table"].items()
}
STATISTICS: dict[str, list[float]] = _PRINTED["statistics"]
