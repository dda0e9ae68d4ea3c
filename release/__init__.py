"""The release folder (`make release`): wheels, sdist, bill of materials, checksums, notes, recipe.

Nothing is published: that is the act of the owner of the names.
"""
