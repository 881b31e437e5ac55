# SPDX-License-Identifier: Apache-2.0
"""Errors and warnings."""
import pathlib
import sys
import warnings


class Error(RuntimeError):
    """Raised if data are bad, or if the machine cannot do what was asked.

    The message is one line that names the file or the scene's key, what was found and what was expected. Wrong
    arguments (shapes, types, axes, unknown keywords) are ``TypeError`` and ``ValueError`` instead; a stopped picture is
    ``KeyboardInterrupt``.

    >>> lamina.render({"version": 1, "volume": "nowhere.nrrd"})
    Traceback (most recent call last):
    lamina.Error: nowhere.nrrd: cannot open: No such file or directory
    """


class PrecisionWarning(UserWarning):
    """An array was converted to float32, which cannot hold its values: the message says how many differ and by how
    much. ``Volume.conversion`` keeps it."""


class PictureWarning(UserWarning):
    """Something in data or picture is noteworthy and shows in no number: a picture that shows nothing, for example.
    ``Picture.warnings`` has the same texts."""


def warn(text: str, category: type[Warning]) -> None:
    """Warns at the line of the program that called the package."""
    package, level, frame = str(pathlib.Path(__file__).parent), 2, sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(package):
        frame, level = frame.f_back, level + 1
    warnings.warn(text, category, stacklevel=level)
