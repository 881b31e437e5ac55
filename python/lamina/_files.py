# SPDX-License-Identifier: Apache-2.0
"""Files that appear when they are complete."""
from __future__ import annotations

import os
import pathlib
import tempfile

from ._errors import Error


def _mode_of(file: pathlib.Path) -> int:
    """Returns the permissions of the file that is replaced, or those of a new one."""
    try:
        return file.stat().st_mode & 0o777
    except OSError:
        umask = os.umask(0)
        os.umask(umask)
        return 0o666 & ~umask


def write_file(file: pathlib.Path, content: bytes) -> None:
    """Writes beside the file and renames. Raises lamina.Error if that cannot be done."""
    try:
        descriptor, name = tempfile.mkstemp(dir=file.parent, prefix=f"{file.name}.", suffix=".part")
        try:
            with os.fdopen(descriptor, "wb") as stream:
                stream.write(content)
            os.chmod(name, _mode_of(file))
            os.replace(name, file)
        except BaseException:
            os.unlink(name)
            raise
    except OSError as error:
        raise Error(f"{file}: cannot write: {error.strerror}") from None
