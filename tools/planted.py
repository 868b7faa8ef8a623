"""The text of a planted mistake in a source file, however the lines are laid out: white space between its words does not
count. For tools/check_mutations and tools/check_reference_mutations."""
import re


def find(source, text):
    """The match of text's first occurrence in source, or None."""
    return re.search(r"\s*".join(map(re.escape, re.findall(r"\w+|[^\w\s]", text))), source)


def plant(source, text, mistake):
    """source with the mistake in place of text's first occurrence, which must be there."""
    found = find(source, text)
    return source[:found.start()] + mistake + source[found.end():]
