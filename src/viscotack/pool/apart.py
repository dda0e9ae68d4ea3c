"""Functions called in a child process with limits of time and memory."""

from collections.abc import Callable, Mapping
from typing import Any, Self

from viscotack import system
from viscotack.errors import InputError

from .event import NoWorker
from .supervisor import Limits, Pool, Setup
from .worker import named

_INTERVAL = 1.0  # between two polls of the child [s]


class Exceeded(InputError):
    """A function exceeded the limits of its process, or ended the process."""


class Apart:
    """A child process that calls functions of this package with limits; use it by ``with``.

    It starts with the first call, and again after a call that ended it.

    Parameters
    ----------
    prepare : str
        ``"module:function"``, called without limits when the process starts, for slow imports.
    """

    def __init__(self, prepare: str = f"{__name__}:no_imports") -> None:
        self._pool = Pool(Setup(prepare, None), 1)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._pool.dismiss(at_once=True)

    def call(
        self,
        function: Callable[..., Any],
        *given: Any,
        seconds: float,
        memory: float,
        **more: Any,
    ) -> Any:
        """Call a function in the child, and return its answer.

        Parameters
        ----------
        function : callable
            Function of a module; its arguments and its answer must be picklable.
        *given, **more
            Its arguments.
        seconds : float
            Time limit [s], the start of the process not counted.
        memory : float
            Memory that the call may allocate [bytes].

        Raises
        ------
        Exceeded
            If the call exceeds a limit, or its process ends.
        Exception
            Whatever the function raises.
        """
        name = f"{function.__module__}:{function.__qualname__}"
        try:
            while not self._pool.room():
                self._pool.collect(_INTERVAL)
        except NoWorker as error:
            raise Exceeded(str(error)) from None
        limits = Limits(seconds, memory=memory)
        self._pool.hand(0, f"{__name__}:call", (name, memory, given, more), limits)
        while True:
            for _, event in self._pool.collect(_INTERVAL):
                match event.kind:
                    case "answer":
                        return _answer(event.what, memory)
                    case "time limit":
                        raise Exceeded(f"reading takes more than {seconds:.0f} s")
                    case "memory limit":
                        raise Exceeded(_too_much(memory))
                raise Exceeded(f"the process that reads it {event.what}")


def no_imports(given: None) -> None:
    """Prepare a child: it imports a function with its first call."""


def call(
    asked: tuple[str, float, tuple[Any, ...], Mapping[str, Any]], tell: object, context: None
) -> tuple[bool, Any]:
    """Call a function; return whether it returned, and its answer or its exception."""
    name, memory, given, more = asked
    function = named(name)
    system.bound_memory(int(system.address_space() + memory))
    try:
        return True, function(*given, **more)
    except Exception as error:
        # the frames of a traceback keep what was read, and cannot be sent
        return False, error.with_traceback(None)


def _answer(found: tuple[bool, Any], memory: float) -> Any:
    returned, what = found
    if returned:
        return what
    if isinstance(what, MemoryError):
        raise Exceeded(_too_much(memory))
    raise what


def _too_much(memory: float) -> str:
    return f"reading takes more than {memory / 1e6:.0f} MB of memory"
