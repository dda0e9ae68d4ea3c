"""Problems that the tiers are tested with: Tabor numbers, materials and rates; a punch."""

import viscotack as vt
from dimensionless import punch


def refusal(tier, case):
    """Return why a tier does not answer a problem, or an empty string."""
    try:
        tier.answer(case)
    except vt.OutOfRange as reason:
        return str(reason)
    return ""


_SOLID = dict(rubbery_modulus=1.0, glassy_modulus=10.0, tau0=1.0, poisson_ratio=0.0)
SOLIDS = vt.StandardSolid(**_SOLID), vt.RetardationPowerLaw(**_SOLID, exponent=0.6)
_SOFT = vt.Elastic(rubbery_modulus=1.0, poisson_ratio=0.0)
PROBLEMS = (
    *(vt.Groups(tabor, _SOFT, vt.AtForce(1.0), 1.0) for tabor in (0.2, 1.5, 8.0)),
    # a large preload, from which a fast retraction meets the glassy solid
    vt.Groups(1.5, SOLIDS[0], vt.AtForce(300.0), 1e7),
    punch(vt.AtForce(0.1), size=60.0, thickness=3.0, rate=10.0),
    *(
        vt.Groups(tabor, SOLIDS[i % 2], vt.AtForce(2.0 * max(tabor, 1.0)), rate)
        for i, (tabor, rate) in enumerate(
            [(0.05, 1.0), (1.5, 10.0), (4.0, 100.0), (60.0, 1e3), (1e7, 1.0)]
        )
    ),
)
