"""Methods of assessment that are functions of a loop."""

import functools
import inspect
import json
import math
import os
import pathlib
import selectors
import socket
import sys
import tempfile
import time
import types

from .identity import digest
from .signals import Loop, told
from .words import toml

READ_SIZE = 1 << 20  # bytes; most messages are smaller
LONGEST_TIME = 86400  # seconds; a function of this process is stopped by its user


def method(function=None, *, needs=(), answers=(), numbers=None, name=None, title=None, verdict=None, learn=None,
           threshold_option=None):
    """Makes a method of assessment of a function of a loop (`Loop`), which returns the answer on it.

    `needs`, `answers`: what a loop must have, and what the method tells besides its verdict: words of
    docs/bring_your_own.md, which has the keys of the answer as well. An answer may also be True or False alone. `numbers`:
    further numbers, {name: scope} or {name: (scope, meaning, unit)} with the scope "loop", "cv" or "channel". `name`,
    `title`, `verdict`: for tables; the name and the first line of the docstring of the function without them. `learn`: a
    function of the context, called once for each benchmark; what it returns is `loop.learnt`. Keywords of the function
    are the options of the method: `def mine(loop, *, threshold=1.5)`. `threshold_option`: the name of the option that
    the scores are compared with, and that nothing else in an answer depends on; then a change of it asks the function
    about few loops only (docs/bring_your_own.md).

    An answer must depend on its loop only, not on earlier ones.
    """
    def made(function):
        return Method(function, needs=needs, answers=answers, numbers=numbers or {}, name=name, title=title,
                      verdict=verdict, learn=learn, threshold_option=threshold_option)
    return made if function is None else made(function)


class Method:
    """A function of a loop with the description of a method; calling it calls the function."""

    def __init__(self, function, *, needs, answers, numbers, name, title, verdict, learn, threshold_option=None, options=None):
        functools.update_wrapper(self, function)
        self.function, self.learn = function, learn
        self.name = name or function.__name__.strip("_").replace("<lambda>", "mine")
        self.needs, self.answers = (texts(self.name, *each) for each in (("needs", needs), ("answers", answers)))
        self.numbers = numbers
        if not isinstance(numbers, dict) or not all(isinstance(scope, (str, tuple, list)) for scope in numbers.values()):
            raise TypeError(f"method {self.name}: numbers: found {numbers!r}; allowed: {{name: scope}} or {{name: (scope, "
                            "meaning, unit)}")
        first_line = (inspect.getdoc(function) or "").split("\n\n")[0].replace("\n", " ").rstrip(".")
        self.title, self.verdict = title or self.name, verdict or first_line or "as the function means it"
        self.options = dict(options or {})
        known = [each.name for each in inspect.signature(function).parameters.values()
                 if each.kind == inspect.Parameter.KEYWORD_ONLY]
        for option in self.options:
            if option not in known:
                raise TypeError(f"method {self.name}: found the option '{option}'; allowed: {', '.join(known) or 'none'}")
        self.threshold_option = threshold_option
        if threshold_option is not None and not isinstance(self._threshold(), (int, float)):
            raise TypeError(f"method {self.name}: threshold_option: found {threshold_option!r}; allowed: the name of a number "
                            f"among its options ({', '.join(known) or 'none'})")

    def _threshold(self):
        default = inspect.signature(self.function).parameters.get(self.threshold_option)
        return self.options.get(self.threshold_option, default and default.default)

    def with_options(self, name=None, **options):
        """The same method with other options, under another name for tables that have both."""
        return Method(self.function, needs=self.needs, answers=self.answers, numbers=self.numbers, name=name or self.name,
                      title=name or self.title, verdict=self.verdict, learn=self.learn,
                      threshold_option=self.threshold_option, options=self.options | options)

    def __call__(self, loop):
        if self.learn is not None and loop.learnt is None:
            loop.learnt = self.learn(loop.context)
        return self.function(loop, **self.options)

    def description(self):
        return {"title": self.title, "verdict": self.verdict, "needs": self.needs, "answers": self.answers,
                "numbers": [{"name": name, **dict(zip(("scope", "meaning", "unit"),
                                                      [scope] if isinstance(scope, str) else scope))}
                            for name, scope in self.numbers.items()]}

    def settings(self):
        """The table of the method in a method file, but for its command. The code is an option, so that answers of
        another function are never taken for those of this one; of the threshold it has nothing."""
        function, threshold = self.function, {}
        if self.threshold_option is not None:
            threshold = {self.threshold_option: self._threshold()}
            function = types.FunctionType(function.__code__, function.__globals__, function.__name__,
                                          function.__defaults__, function.__closure__)
            function.__kwdefaults__ = {name: value for name, value in (self.function.__kwdefaults__ or {}).items()
                                       if name != self.threshold_option}
        options = {**self.options, **threshold, "code": digest(function, self.learn, self.description())}
        return {"options": options, **({"threshold_option": self.threshold_option} if threshold else {})}

    def told_apart_by(self):
        """What identity.digest() looks into."""
        return self.function, self.learn, self.options

    def __repr__(self):
        return f"<mpmbench.Method {self.name}: {self.verdict}>"


def split(methods):
    """Names of methods, and methods of this process."""
    if isinstance(methods, (str, Method)):
        methods = [methods]
    methods = list(methods or [])
    own = [each for each in methods if isinstance(each, Method)]
    for each in methods:
        if not isinstance(each, (str, Method)):
            raise TypeError(f"methods: found {each!r}; allowed: names, and functions with @mpmbench.method")
    return [each if isinstance(each, str) else each.name for each in methods], own


def texts(name, key, given):
    """The list under a key of a method. A text is one where a list of texts is meant."""
    if isinstance(given, (list, tuple, set, frozenset)) and all(isinstance(each, str) for each in given):
        return list(given)
    raise TypeError(f"method {name}: {key}: found {given!r}; allowed: a list of texts, such as {['benchmark' if key == 'needs' else 'cv']}")


class Session:
    """A method in a conversation with the program, which has told it the context of the loops."""

    def __init__(self, method):
        self.method, self.context, self.learnt = method, None, None
        self.seconds = []  # processor time of each verdict

    def answer(self, line):
        """The line that answers a line of the protocol of docs/bring_your_own.md."""
        start = time.thread_time()
        message = json.loads(line)
        said = getattr(self, "_" + message["ask"])(message[message["ask"]])
        text = json.dumps({"number": message["number"], **plain(said)}, allow_nan=False)
        if message["ask"] == "loop":
            self.seconds.append(time.thread_time() - start)
        return text.encode() + b"\n"

    def _describe(self, asked):
        # what names the code of the function is not for it
        options = {name: value for name, value in asked["options"].items() if name != "code"}
        self.method = self.method.with_options(**options)
        signals = {"signals": "base64"} if "base64" in asked.get("signals", []) else {}
        return {**self.method.description(), **signals}

    def _context(self, context):
        self.context = context
        self.learnt = self.method.learn and self.method.learn(told(context))
        self._benchmark = Loop(context["benchmark"], context, self.learnt)
        return {}

    def _loop(self, signals):
        loop = Loop(signals, self.context, self.learnt, signals.get("whole"), signals.get("first", 0))
        loop.benchmark = self._benchmark
        said = self.method(loop)
        if isinstance(said, dict):
            return said
        if isinstance(said, bool) or type(said).__name__ == "bool_":
            return {"flagged": said}
        raise TypeError(f"method {self.method.name}: found the answer {said!r}; allowed: a dict with at least 'flagged', "
                        "or True or False")


def plain(value):
    """A value as JSON has it: lists for arrays, null for NaN, texts for infinities."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else "Infinity" if value > 0 else "-Infinity"
    if isinstance(value, dict):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(each) for each in value]
    return value


def serve(method, needs=(), answers=()):
    """Serves the method as a program: reads the messages of mpmbench from stdin and answers on stdout until stdin ends.
    An exception of the function is the reason why its loop has no verdict. What the function prints goes to stderr."""
    if not isinstance(method, Method):
        method = globals()["method"](method, needs=needs, answers=answers)
    if sys.stdin.isatty():
        sys.exit(f"{sys.argv[0]}: a method that mpmbench starts; name it in a file for --method-file")
    answers_end, sys.stdout = sys.stdout.buffer, sys.stderr
    session = Session(method)
    for line in open(sys.stdin.fileno(), "rb", buffering=READ_SIZE, closefd=False):
        if not line.strip():  # an empty line follows each message
            continue
        try:
            answer = session.answer(line)
        except Exception as error:  # of somebody else's function
            message = json.loads(line)
            if message["ask"] != "loop":
                raise
            answer = json.dumps({"number": message["number"], "error": f"{type(error).__name__}: {error}"}).encode() + b"\n"
        answers_end.write(answer)
        answers_end.flush()


class Broker:
    """Serves methods of this process to a program that it runs. The program starts relays (relay.py), which connect to a
    socket here. A context manager."""

    def __init__(self, methods):
        self.methods = {}
        for each in methods:
            if each.name in self.methods:
                raise ValueError(f"methods: found two of the name '{each.name}'; allowed: each name once")
            self.methods[each.name] = each
        self.seconds = {name: [] for name in self.methods}
        self.error = None

    def __enter__(self):
        self._folder = tempfile.TemporaryDirectory(prefix="mpmbench-")
        folder = pathlib.Path(self._folder.name)
        self._listener, self._ends = socket.socket(socket.AF_UNIX), []
        short = os.open(folder, os.O_PATH)  # no path of a socket has more than 107 bytes
        try:
            self._listener.bind(f"/proc/self/fd/{short}/socket")
        finally:
            os.close(short)
        self._listener.listen(128)
        self.environment = {"MPMBENCH_SOCKET": str(folder / "socket")}
        relay = pathlib.Path(__file__).with_name("relay.py")
        self.file = folder / "methods.toml"
        self.file.write_text("".join(
            f"[method.{toml(name)}]\n"
            f"command = {toml([sys.executable, '-I', '-S', str(relay), name])}\n"
            f"time_limit = {LONGEST_TIME}\n" + "".join(f"{key} = {toml(value)}\n" for key, value in each.settings().items())
            for name, each in self.methods.items()), encoding="utf-8")
        return self

    def __exit__(self, *_):
        for end in [*self._ends, self._listener]:
            end.close()
        self._folder.cleanup()

    def register(self, selector):
        self._selector = selector
        selector.register(self._listener, selectors.EVENT_READ)

    def serve(self, key):
        """Takes a relay that has come, or what one has sent."""
        if key.fileobj is self._listener:
            end, _ = self._listener.accept()
            self._ends.append(end)
            self._selector.register(end, selectors.EVENT_READ, {"unread": bytearray(), "session": None})
            return
        try:
            piece = key.fileobj.recv(1 << 20)
        except ConnectionError:
            piece = b""
        if not piece:
            self._selector.unregister(key.fileobj)
            key.fileobj.close()
            return
        unread = key.data["unread"]
        unread += piece
        if unread[-1:] != b"\n":
            return
        lines = bytes(unread).splitlines()
        unread.clear()
        for line in lines:
            if key.data["session"] is None:
                session = key.data["session"] = Session(self.methods[line.decode()])
                session.seconds = self.seconds[line.decode()]
            elif line.strip():
                try:
                    key.fileobj.sendall(key.data["session"].answer(line))
                except ConnectionError:  # the program is ending
                    return

    def words(self):
        return ["--method-file", self.file] if self.methods else []


