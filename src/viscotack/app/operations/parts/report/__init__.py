"""Report of a study as a web page: data, interface, forecast and method."""

from .rendering import page

__all__ = ["page"]
