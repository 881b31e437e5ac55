# SPDX-License-Identifier: Apache-2.0
"""The page that shows the pictures side by side."""
import html

HEAD = """<!DOCTYPE html><meta charset="utf-8"><title>lamina and VTK, as they come</title>
<style>body { font-family: sans-serif; margin: 1em; background: #888 } img { width: 100%; display: block }
section { display: grid; grid-template-columns: 1fr 1fr; gap: .4em; margin-bottom: 1.5em }
h2, p { grid-column: 1 / 3; margin: 0 } p { font-size: small; white-space: pre-wrap } figcaption { font-size: small }
figure { margin: 0 }</style>
"""


def figure(who, side):
    if side is None:
        return f"<figure><figcaption>{who}: not drawn</figcaption></figure>"
    if side.error:
        return f"<figure><figcaption>{who}: {html.escape(side.error)}</figcaption></figure>"
    time = f", {side.seconds:.2f} s" if side.seconds else ""
    return (f'<figure><img src="{html.escape(side.picture)}" alt="{who}">'
            f"<figcaption>{who}{time}</figcaption></figure>")


def text_of(drawn, size):
    parts = [HEAD, f"<h1>lamina (left) and VTK's defaults (right), {size}</h1>\n"]
    for one in drawn:
        parts.append(f"<section><h2>{html.escape(one.name)}</h2>{figure('lamina', one.ours)}"
                     f"{figure('VTK', one.theirs)}<p>{html.escape(one.ours.said)}</p></section>\n")
    return "".join(parts)
