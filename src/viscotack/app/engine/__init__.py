"""Engine of page and API: states, fast answers, and jobs in worker processes."""
