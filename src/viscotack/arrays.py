"""The type of arrays of numbers, for all modules."""

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
