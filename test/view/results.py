"""The results of a test: a line for each check, and how many failed."""
import sys

failures = []


def check(name, good, *about):
    """about: what a reader of the failure needs."""
    print(("ok " if good else "not ok ") + name)
    if not good:
        failures.append(name)
        print("  ", *about, file=sys.stderr)


def end():
    sys.exit(1 if failures else 0)
