"""Bad input, told apart from defects."""


class InputError(ValueError):
    """What was given cannot be: the words say what was wrong, what was given and what to do.

    Everything else that escapes is a defect of viscotack.
    """
