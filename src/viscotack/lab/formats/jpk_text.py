"""Layout of JPK's text exports: a header in comments above each segment, then columns of numbers.

The header names the columns (``# columns: vDeflection measuredHeight seriesTime``) and their units
(``# units: N m s``), and the spring constant of the cantilever.
"""

from itertools import groupby, zip_longest

import numpy as np

from .file import Curve, LabFile, in_sequence
from .jpk import HEIGHTS

_LOOKED = 300  # lines searched for the first header
# positions of the tip, from which the bending of the cantilever is already subtracted
_TIPS = ("verticalTipPosition", "tipSampleSeparation")


def curves(file: LabFile, *_: object) -> list[Curve] | None:
    """Return the consecutive segments of a force curve as one curve; None for other files.

    Raises
    ------
    ValueError
        If a row is damaged, a column is missing, or a force is not in newtons.
    """
    if not any(text.startswith("# columns:") for text in file.lines[:_LOOKED]):
        return None
    # what one header states holds for the next until it is stated again
    words: dict[str, str] = {}
    segments = []
    lines = filter(str.strip, file.lines)
    for above, group in groupby(lines, lambda text: text.startswith("#")):
        if above:
            pairs = (text.lstrip("# ").partition(":") for text in group)
            words |= {key.strip(): value.strip() for key, colon, value in pairs if colon}
            continue
        columns = zip_longest(words["columns"].split(), words.get("units", "").split())
        numbers = np.loadtxt(list(group), ndmin=2).T
        segments.append(dict(zip(columns, numbers, strict=True)))
    if not segments:
        raise file.error("no segment has points below '# columns:' and '# units:'")
    shared = set.intersection(*map(set, segments))
    clock, used = (
        next((each for each in names if (each, unit) in shared), "")
        for names, unit in ((("seriesTime", "time"), "s"), ((*HEIGHTS, *_TIPS), "m"))
    )
    if not (clock and used and ("vDeflection", "N") in shared):
        found = ", ".join(f"{name} [{unit}]" for name, unit in segments[0])
        raise file.error(
            f"each segment needs a calibrated vDeflection [N], a height [m] and seriesTime or time "
            f"[s]; found {found}"
        )
    stiffness = 0.0 if used in _TIPS else float(words["springConstant"])
    wanted = ((clock, "s"), ("vDeflection", "N"), (used, "m"))
    parts = [[segment[column] for column in wanted] for segment in segments]
    # the time of a series, or of each segment from its own start
    numbers = np.hstack(parts) if clock == "seriesTime" else in_sequence(parts)
    # heights increase away from the sample
    return [Curve(*numbers, -1, stiffness, (f"position from the column {used}",))]
