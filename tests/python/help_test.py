# SPDX-License-Identifier: Apache-2.0
import pydoc

import lamina


def test_help_reads_like_a_page():
    page = pydoc.plain(pydoc.render_doc(lamina))
    begin = page[:page.index("PACKAGE CONTENTS")]
    for name in lamina.__all__:
        if name not in ("Norms", "Omission", "Plan", "PictureWarning", "PrecisionWarning", "colormaps"):
            assert f"``{name}``" in begin or f"``lamina.{name}``" in begin, name
    for name in ("render", "trace", "compare", "study", "read", "mesh"):
        assert f"\n    {name}(" in page, name
    assert "class Volume(builtins.object)" in page and "lamina._volume" not in page
    assert all(len(line) <= 130 for line in begin.splitlines())


def test_only_what_is_meant_is_there():
    assert lamina.__version__.count(".") == 2
    assert set(lamina.__all__) <= set(dir(lamina))
    try:
        lamina.nothing
    except AttributeError as error:
        assert "nothing" in str(error)
