"""Contacts for other programs: force tables, a controller of a release, a contact with memory."""

from .reduced import ContactState, ReducedContact, reduced_contact
from .release import Release, Released, let_go
from .table import ForceTable, force_table
from .writing import c_header, fmu, reduced_header

__all__ = [
    "ContactState",
    "ForceTable",
    "ReducedContact",
    "Release",
    "Released",
    "c_header",
    "fmu",
    "force_table",
    "let_go",
    "reduced_contact",
    "reduced_header",
]
