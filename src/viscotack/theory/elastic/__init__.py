"""Contacts of elastic solids."""
