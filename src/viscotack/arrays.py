"""Type alias for arrays of floating-point numbers, used by all modules."""

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
