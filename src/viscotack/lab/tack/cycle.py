"""What one cycle of a tack test says: pull-off, work, depths and speeds, each with its uncertainty.

Force is positive in compression, depth positive into the solid and zero where the sphere first
touches; the pull-off force is a positive number. Uncertainties are standard ones (68 %).
"""

from dataclasses import dataclass

from viscotack.arrays import Array
from viscotack.lab.sweeps import Source
from viscotack.renamed import Renamed

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
        From 1, in the order of the record.
    time, force, depth : ndarray, shape (N,)
        Of the whole cycle [s, N, m], corrected for zero, tilt, drift and compliance.
    contact_radius : ndarray or None
        From a camera [m].
    segments : Segments
        Where approach, dwell and retraction begin in these arrays.
    pull_off_force : Measured
        Largest tension of the retraction [N].
    pull_off_raw : float
        The same as it stands in the file, without any correction [N].
    pull_off_at : int
        Index of that point in the arrays.
    depth_at_pull_off : Measured
        Depth there [m].
    work_to_pull_off, work_of_separation : Measured
        Integral of -force d(depth) from the last zero crossing of the force to the pull-off and
        to the end of the contact [J].
    preload : Measured
        Largest force before the retraction [N].
    preload_depth : Measured
        Depth where the retraction begins [m].
    dwell_time : float
        Between approach and retraction [s].
    speed : Measured
        True speed of the drive between the zero crossing of the force and the pull-off [m/s], and
        how far that is from even.
    mean_speed : Measured
        Over the whole retraction [m/s].
    approach_speed : float or None
        In the middle of the approach [m/s].
    noise : float
        Standard deviation of the force out of contact [N].
    source : Source
        Where the numbers come from; its notes say what was decided.
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

    pull_off_depth = Renamed("depth_at_pull_off")

    @property
    def retraction(self) -> slice:
        """The points of the retraction."""
        return slice(self.segments.retract, self.segments.end)
