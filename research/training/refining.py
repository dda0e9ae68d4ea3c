"""A second look: networks that learn what others leave over.

A network fitted to its end leaves smooth errors of a tenth of a percent, many times what the rows
are uncertain by, and more steps or nodes hardly change it. A second one that learns the errors of
the first, magnified, halves them in a fraction of the steps; its hidden layers stand beside those
of the first, so that both are one network when they are asked.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, replace

import numpy as np

from viscotack.arrays import Array
from viscotack.prediction.surrogate.network import Networks

from .fitting import Fit, Task
from .joining import added, together
from .shop import Shop

# A shape's values that hardly vary are not worth all of the network's attention.
_LEAST_SPREAD = 0.03


@dataclass(frozen=True, eq=False)
class Scaled:
    """A task whose targets are of order one, and centre and spread as ``Networks`` have them."""

    task: Task
    centre: Array
    spread: Array

    def of(self, networks: Networks) -> Networks:
        """Return networks that learned the task, in the units of the targets."""
        return replace(networks, centre=self.centre, spread=self.spread)


def scaled_task(inputs: Array, target: Array, known: Array | None = None) -> Scaled:
    """Return the task to learn targets, each scaled by its mean and deviation."""
    known = np.ones_like(target) if known is None else known
    count = known.sum(axis=0)
    centre = (known * target).sum(axis=0) / count
    spread = np.sqrt((known * (target - centre) ** 2).sum(axis=0) / count)
    spread = np.maximum(spread, _LEAST_SPREAD)
    return Scaled(Task(inputs, (target - centre) / spread, known), centre, spread)


@dataclass(frozen=True)
class Stage:
    """Networks that learn what is left over, whose outputs are added times a gain.

    The scale of the fit is about the size of the errors that are left.
    """

    fit: Fit
    gain: float


@dataclass(frozen=True)
class Looks:
    """How a network is fitted, and the one that learns what it leaves over."""

    first: Fit
    second: Stage


@dataclass(frozen=True, eq=False)
class Begun:
    """A network, and the one that is being fitted to what it leaves over."""

    first: Networks
    second: Future[Networks]

    def done(self) -> Networks:
        """Return both as one when the second is done."""
        return added(self.first, self.second.result())


def again(first: Networks, task: Task, stage: Stage, shop: Shop, seed: int) -> Begun:
    """Begin to learn what one network leaves over of a task."""
    left = replace(task, before=first.plain(task.inputs)[0], gain=stage.gain)
    return Begun(first, shop.fit(left, stage.fit, seed=seed))


def all_done(begun: Sequence[Begun]) -> Networks:
    """Return several networks as one object when they are done."""
    return together([one.done() for one in begun])


def twice(tasks: Sequence[Task], looks: Looks, shop: Shop) -> Callable[[], Networks]:
    """Begin to learn tasks, a network each; what is returned waits, and looks at each again."""
    begun = [shop.fit(task, looks.first, seed=i) for i, task in enumerate(tasks)]

    def done() -> Networks:
        firsts = zip(tasks, [one.result() for one in begun], strict=True)
        return all_done([again(f, t, looks.second, shop, i) for i, (t, f) in enumerate(firsts)])

    return done
