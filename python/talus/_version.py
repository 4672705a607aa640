"""Version of the package, that of the sources it stands in; "unknown" of a copy without them. Installed copies have this
file with the number alone."""

import re
from pathlib import Path

_sources = Path(__file__).resolve().parents[2] / "CMakeLists.txt"
_found = re.search(r"project\(talus VERSION ([0-9.]+)", _sources.read_text()) if _sources.is_file() else None
version = _found.group(1) if _found else "unknown"
