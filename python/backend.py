"""Makes the package ready for an installation, for pip (PEP 517, 660) and for CMake alike; needs nothing but Python.

    pip install ./python            a wheel
    python3 backend.py FOLDER       the same files in a folder, such as PREFIX/lib/python3.11/dist-packages

The version comes from CMakeLists.txt, the header talus.h from include: neither is written down again.
"""

import base64
import hashlib
import re
import sys
import tomllib
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parent
VERSION = re.search(r"project\(talus VERSION ([0-9.]+)", (SOURCE / "CMakeLists.txt").read_text()).group(1)
INFO = f"talus-{VERSION}.dist-info"


def metadata():
    """What pyproject.toml says, as METADATA says it."""
    project = tomllib.loads((HERE / "pyproject.toml").read_text())["project"]
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {VERSION}",
             f"Summary: {project['description']}", f"Requires-Python: {project['requires-python']}"]
    lines += [f"Requires-Dist: {name}" for name in project["dependencies"]]
    for extra, names in project["optional-dependencies"].items():
        lines += [f"Provides-Extra: {extra}", *(f'Requires-Dist: {name}; extra == "{extra}"' for name in names)]
    return "\n".join(lines) + "\n"


def information():
    """Files about the package: {name: bytes}."""
    wheel = "Wheel-Version: 1.0\nGenerator: talus\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
    return {f"{INFO}/METADATA": metadata().encode(), f"{INFO}/WHEEL": wheel.encode(),
            f"{INFO}/LICENSE": (SOURCE / "LICENSE").read_bytes()}


def package():
    """Files of the package: {name: bytes}."""
    files = {f"talus/{file.name}": file.read_bytes() for file in sorted((HERE / "talus").glob("*.py"))}
    files["talus/_version.py"] = f'"""Version of the package."""\n\nversion = "{VERSION}"\n'.encode()
    files["talus/talus.h"] = (SOURCE / "include" / "talus.h").read_bytes()
    return files


def _write_wheel(folder, files):
    name = f"talus-{VERSION}-py3-none-any.whl"
    record = ""
    with zipfile.ZipFile(Path(folder) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, data in files.items():
            wheel.writestr(path, data)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record += f"{path},sha256={digest},{len(data)}\n"
        wheel.writestr(f"{INFO}/RECORD", record + f"{INFO}/RECORD,,\n")
    return name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    return _write_wheel(wheel_directory, {**package(), **information()})


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    return _write_wheel(wheel_directory, {"talus.pth": f"{HERE}\n".encode(), **information()})


def install(folder):
    """Write all files below a folder; returns their paths."""
    written = []
    for name, data in {**package(), **information()}.items():
        path = Path(folder) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
        written.append(str(path))
    return written


if __name__ == "__main__":
    print("\n".join(install(sys.argv[1])))
