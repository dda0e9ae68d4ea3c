"""Steady cracks and pull-offs by other formulations than those of the package.

`half_plane` solves the steady crack by a Galerkin method for a harmonic function in the half-plane,
in logarithmic polar coordinates: opening and closing, Lennard-Jones forces, any creep in modes.
`sphere` solves the round contact by a Galerkin method in Abel's variable: for a given place of the
edge, elastic or with an edge of one speed, at Tabor numbers of 5 to 200, and a retraction in time.
Only `compare` imports the package, and puts both answers side by side; `agreement.json` keeps them.
"""
