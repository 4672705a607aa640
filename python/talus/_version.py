"""Version of the package, that of the sources it stands in. Installed copies have this file with the number alone."""

import re
from pathlib import Path

_sources = Path(__file__).resolve().parents[2] / "CMakeLists.txt"
version = re.search(r"project\(talus VERSION ([0-9.]+)", _sources.read_text()).group(1)
