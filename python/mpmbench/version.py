"""The version of the package, that of the program it belongs to (a test compares them)."""

__version__ = "0.2.0"
