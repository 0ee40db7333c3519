"""The version of the package, which equals that of the program (a test compares them)."""

__version__ = "0.2.0"
