r"""Force on the flank beyond the last node, relative to that of a sphere (Derjaguin).

For a sphere the area between two gaps does not depend on the distance. The force on its flank is
the energy of the law at the gap g of the last node, times a constant. For a tip that rises like
:math:`r^q`, this area grows like :math:`w = (h/g)^p` with :math:`p = (2-q)/q`, and the force is
multiplied by

.. math:: \frac{\int_g^\infty w\,\sigma\,dh}{-\varphi(g)}
          = 1 + \int_g^\infty w' \frac{\varphi(h)}{\varphi(g)}\,dh
          = 1 + p \int_0^1 x^{-1-p}\, \frac{\varphi(g/x)}{\varphi(g)}\,dx .

For a tension that falls like :math:`h^{-3}` this factor is :math:`q/(\frac32 q - 1)`. For a law
that vanishes before the last node it is 1.
"""

from __future__ import annotations

import numpy as np

from viscotack.model.traction import Traction

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(40)
_NODES, _WEIGHTS = (_NODES + 1) / 2, _WEIGHTS / 2


def flank_share(law: Traction, gap: float, exponent: float) -> float:
    """Return the force on a flank that rises like r^q, over that of the same area throughout.

    Parameters
    ----------
    law : Traction
        Reduced traction law.
    gap : float
        Gap at the last node [h0].
    exponent : float
        The exponent q, at least 1.
    """
    at_node = float(law.energy(gap))
    if at_node == 0:
        return 1.0
    p = (2 - exponent) / exponent
    fading = law.energy(gap / _NODES) / at_node
    return 1 + p * float(_WEIGHTS @ (_NODES ** (-1 - p) * fading))
