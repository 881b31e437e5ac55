# SPDX-License-Identifier: Apache-2.0
"""The fenced blocks of a page of the manual, and the command lines in all its blocks."""
import re


def fenced(text, language):
    """The contents of all blocks of that language, in order."""
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def command_lines(text):
    """Lines of all blocks, fenced or indented, that call lamina: continued ones joined, without comments."""
    joined = re.sub(r"\\\n\s*", " ", text)
    fences = "\n".join(re.findall(r"^```(?:sh|text)?\n(.*?)^```$", joined, re.MULTILINE | re.DOTALL))
    outside = re.sub(r"^```.*?^```$", "", joined, flags=re.MULTILINE | re.DOTALL)
    indented = "\n".join(line for line in outside.splitlines() if line.startswith("    "))
    calls = re.findall(r"^\s*(?:\$ )?(?:build/release/)?(lamina [a-z]+ .*)$", fences + "\n" + indented, re.MULTILINE)
    return [re.sub(r"\s#\s.*$", "", call) for call in calls]
