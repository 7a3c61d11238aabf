"""The interfaces of hamel that return numbers: `eval` and `linearize`, and generated C, compiled."""

import ctypes
import json
import os
import re
import subprocess


class Refused(Exception):
    """Raised if hamel refuses a text, with its message."""


class Doors:
    """The interfaces for one text, in a separate folder."""

    def __init__(self, hamel, folder):
        self.hamel, self.folder = hamel, folder
        os.makedirs(folder, exist_ok=True)
        self.file = os.path.join(folder, "system.eom")

    def write(self, text):
        with open(self.file, "w", encoding="utf-8") as out:
            out.write(text)

    def run(self, *arguments, text=None):
        done = subprocess.run([self.hamel, *arguments], input=text, capture_output=True, text=True, timeout=600)
        if done.returncode != 0:
            raise Refused(f"{' '.join(arguments)}: status {done.returncode}\n{done.stderr}")
        return done.stdout

    def eval(self, state=None):
        at = ["--at", "-"] if state else []
        return json.loads(self.run("eval", self.file, "--tables", *at, text=json.dumps(state)))

    def linearize(self, state, full=True):
        more = ["--full"] if full else []
        return json.loads(self.run("linearize", self.file, "--format", "json", *more, "--at", "-", text=json.dumps(state)))

    def compiled(self, single=False):
        return Compiled(self, single)


class Compiled:
    """Generated C as a library; its version in doubles has been written."""

    def __init__(self, doors, single):
        base = os.path.join(doors.folder, "single" if single else "double")
        if single:
            doors.run("emit", doors.file, "--language", "c", "--precision", "float", "-o", base)
        with open(base + ".h", encoding="utf-8") as header:
            text = header.read()
        command = ["gcc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-O0", "-shared", "-fPIC", base + ".c", "-o", base + ".so", "-lm"]
        made = subprocess.run(command, capture_output=True, text=True)
        if made.returncode != 0:
            raise Refused("gcc: " + made.stderr)
        self.library = ctypes.CDLL(os.path.abspath(base + ".so"))
        self.number = ctypes.c_float if single else ctypes.c_double
        self.prefix = re.search(r"void (\w+)_default_parameters", text).group(1)
        self.functions = self.read(text)
        size = re.search(r"_real k\[(\d+)\]", text)
        self.system = (ctypes.c_byte * 0)()
        if f"{self.prefix}_set_parameters(" in text:
            count = (int(size.group(1)) if size else 0) + 4096
            self.system = (self.number * count)()
            self.parameters = (self.number * 1024)()
            getattr(self.library, f"{self.prefix}_default_parameters")(self.parameters)

    def read(self, text):
        """Names, and the names of their arguments."""
        found = {}
        text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
        for kind, name, arguments in re.findall(r"(void|\w+_real|\w+_status) (\w+)\(([^)]*)\);", text):
            names = [re.search(r"(\w+)$", a.strip()).group(1) for a in arguments.split(",") if a.strip() != "void"]
            found[name.removeprefix(self.prefix + "_")] = (kind, names)
        return found

    def set(self, values):
        for place, value in enumerate(values):
            self.parameters[place] = value
        status = getattr(self.library, f"{self.prefix}_set_parameters")(self.system, self.parameters)
        assert status == 0, f"parameters: status {status}"

    def __contains__(self, name):
        return name in self.functions

    def call(self, name, size, **arguments):
        """Calls a function with this number of results; nothing may be written after them."""
        kind, names = self.functions[name]
        out = (self.number * (size + 8))(*([777.0] * (size + 8)))
        function = getattr(self.library, f"{self.prefix}_{name}")
        given = []
        for argument in names:
            if argument == "system":
                given.append(self.system)
            elif argument == "out":
                given.append(out)
            else:
                values = arguments[argument]
                given.append((self.number * len(values))(*values))
        if kind.endswith("_real"):
            function.restype = self.number
            return [function(*given)]
        status = function(*given)
        if kind.endswith("_status") and status != 0:
            raise Refused(f"{name}: status {status}")
        if any(out[size + k] != 777.0 for k in range(8)):
            raise Refused(f"{name} writes more than {size} numbers")
        return list(out[:size])
