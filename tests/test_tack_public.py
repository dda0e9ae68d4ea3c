"""Public tack tests, which are not in the repository: ``--tack=FOLDER``."""

from pathlib import Path

import numpy as np
import pytest

from modules import module_at

BENCHMARK = Path(__file__).parents[1] / "research" / "public_tack_files.py"


@pytest.mark.outside
def test_every_retraction_of_the_speed_series_is_read_within_one_per_cent(request):
    folder = request.config.getoption("--tack")
    if not folder.is_dir():
        pytest.fail(
            f"no folder {folder}: get 'Raw data/Retraction speed series' of "
            "lloxxa/DOI-10.3389-fphy.2024.1412352 (parent of commit 3af066a2) and give --tack"
        )
    study = module_at(BENCHMARK)
    rows, reasons = [], []
    for paths in study.groups_of(folder).values():
        read, refused = study.outcome(paths)
        rows += [row[:4] for row in read]
        reasons += refused
    assert len(rows) == 360 and reasons == []
    assert np.max(np.abs(np.array(rows))) < 0.01
