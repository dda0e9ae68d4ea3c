from dataclasses import dataclass
from typing import Annotated

import pytest

from viscotack.cards import Quantity, conform


def test_a_number_out_of_its_range_is_refused_with_unit_range_and_cure():
    @dataclass(frozen=True)
    class Wall:
        height: Annotated[
            float, Quantity("m", "h", "height", above=0, most=2, advice="build two walls")
        ]

        def __post_init__(self):
            conform(self)

    assert Wall(1).height == 1.0 and isinstance(Wall(1).height, float)
    with pytest.raises(ValueError, match=r"height must lie in .0, 2., got 3 m; build two walls"):
        Wall(3)
    with pytest.raises(ValueError, match=r"height must be a number in m, got '1 m'; .*parse"):
        Wall("1 m")
    with pytest.raises(ValueError, match="height must be finite"):
        Wall(float("nan"))
