"""Values of Python as words of a command line and as TOML."""

import json
import math
import numbers
import os


def toml(value):
    """A value of a key in TOML: texts, numbers, truth values, lists, arrays and tables."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        value = float(value)
        return repr(value) if math.isfinite(value) else str(value)
    if isinstance(value, (str, os.PathLike)):
        return json.dumps(os.fspath(value), ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, dict):
        return "{" + ", ".join(f"{toml(str(key))} = {toml(each)}" for key, each in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(toml, value)) + "]"
    raise TypeError(f"found {value!r}; allowed: texts, numbers, truth values, and lists and dicts of them")


def options(given):
    """`--some-name VALUE` for each `some_name=value`; True is a flag, None and False are left out, lists are joined by
    commas."""
    for name, value in given.items():
        option = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        yield option
        if value is not True:
            yield ",".join(map(str, value)) if isinstance(value, (list, tuple)) else str(value)


def changes(given):
    """`--set KEY=VALUE` for each key of a study."""
    for key, value in (given or {}).items():
        yield from ("--set", f"{key}={toml(value)}")
