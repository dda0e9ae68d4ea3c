"""Results of one cycle of a tack test: pull-off, work, depths and speeds, with uncertainties.

Force is positive in compression. Depth is positive into the solid and zero at first
contact. The pull-off force is positive. Uncertainties are standard uncertainties (68 %).
"""

from dataclasses import dataclass

from viscotack.arrays import Array
from viscotack.lab.sweeps import Source

from .segments import Segments


@dataclass(frozen=True)
class Measured:
    """A number with its standard uncertainty, in the same unit."""

    value: float
    uncertainty: float


@dataclass(frozen=True, eq=False)
class Cycle:
    """One approach, dwell and retraction.

    Parameters
    ----------
    number : int
        Counted from 1, in the order of the record.
    time, force, depth : ndarray, shape (N,)
        Data of the whole cycle [s, N, m], corrected for zero, tilt, drift and compliance.
    contact_radius : ndarray or None
        Measured by a camera [m].
    segments : Segments
        Indices where approach, dwell and retraction begin in these arrays.
    pull_off_force : Measured
        Largest tension of the retraction [N].
    pull_off_raw : float
        The same from the uncorrected force of the file [N].
    pull_off_at : int
        Index of the pull-off in the arrays.
    depth_at_pull_off : Measured
        Depth at pull-off [m].
    work_to_pull_off, work_of_separation : Measured
        Integral of -force d(depth) from the last zero crossing of the force to the pull-off and
        to the end of the contact [J].
    preload : Measured
        Largest force before the retraction [N].
    preload_depth : Measured
        Depth where the retraction begins [m].
    dwell_time : float
        Time between approach and retraction [s].
    speed : Measured
        True speed of the drive between the zero crossing of the force and the pull-off [m/s];
        the uncertainty is its unevenness.
    mean_speed : Measured
        Speed over the whole retraction [m/s].
    approach_speed : float or None
        Speed in the middle of the approach [m/s].
    noise : float
        Standard deviation of the force out of contact [N].
    source : Source
        Origin of the numbers; its notes list all decisions.
    temperature : float or None
        Mean temperature of the cycle [K]; None where the file states none.
    compliance : float
        Compliance of the rig between drive and contact, subtracted from the depth [m/N].
    cautions : tuple of str
        Signs that the theories of a closing edge do not hold.
    """

    number: int
    time: Array
    force: Array
    depth: Array
    contact_radius: Array | None
    segments: Segments
    pull_off_force: Measured
    pull_off_raw: float
    pull_off_at: int
    depth_at_pull_off: Measured
    work_to_pull_off: Measured
    work_of_separation: Measured
    preload: Measured
    preload_depth: Measured
    dwell_time: float
    speed: Measured
    mean_speed: Measured
    approach_speed: float | None
    noise: float
    source: Source
    temperature: float | None = None
    compliance: float = 0.0
    cautions: tuple[str, ...] = ()

    @property
    def retraction(self) -> slice:
        """Slice of the points of the retraction."""
        return slice(self.segments.retract, self.segments.end)
