"""Every figure and table of the thesis with numbers in it, a small module each.

A module opens with what the figure shows, and with paragraphs that begin with "Claims:", "Needs:"
and "Costs:". ``numbers(bench)`` returns the plotted data, ``draw(numbers, figure)`` draws it.
"""
