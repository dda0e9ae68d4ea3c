"""Master curves and fits of material models to measurements."""
