#!/usr/bin/env python3
"""measure.py TALUS [LIMIT [CASE...]]: runs every case of the gallery that takes less than LIMIT (60) seconds of processor time, one at
a time on one rank, and writes docs/site/times.tsv. Those whose README states minutes are not tried. With names, those cases alone, and
whatever their README states: the rows of all others stay as they were measured."""
import datetime
import os
import resource
import subprocess
import sys
import tempfile

from cases import ROOT, TIMES, all_cases


def processor():
    for line in open("/proc/cpuinfo"):
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return os.uname().machine


def words_of(case):
    """What computes the case: `run` of its case.yaml, or what its page says, on a file of its folder; None where neither is there."""
    command = case.command[0].split()
    if (case.folder / "case.yaml").exists():
        return ["run", str(case.folder / "case.yaml")]
    return [command[1], str(ROOT / command[2])] if command[1] == "element" else None


def seconds_of(talus, case, limit):
    """Processor time of the case's command, or None where it needs more than limit. A run that fails ends the measurement."""
    with tempfile.TemporaryDirectory() as folder:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        status = subprocess.run(
            [talus, *words_of(case), "--out", folder + "/run"], cwd=folder,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
            preexec_fn=lambda: (os.nice(10), resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5)))).returncode
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    if status and seconds < 0.9 * limit:
        sys.exit(f"{case.name}: the run failed")
    return None if status else seconds


def main():
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    talus, limit = os.path.abspath(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 60
    named = sys.argv[3:]
    version = subprocess.run([talus, "version"], capture_output=True, text=True).stdout.split("\n")[0]
    head = "# case\tseconds of processor time\tmeasured with\ton"
    rows = dict(line.split("\t", 1) for line in TIMES.read_text().splitlines() if line[0] != "#") if named else {}
    when = f"{version}, {processor()}, one rank\t{datetime.date.today()}"
    for case in all_cases():
        if not words_of(case) or (case.name not in named if named else case.is_long):
            continue
        seconds = seconds_of(talus, case, limit)
        print(f"{case.name}: {'more than the limit, or failed' if seconds is None else f'{seconds:.1f} s'}", flush=True)
        if seconds is None:
            text = f"more than {limit} s"
        else:
            text = f"{seconds:.1f}" if seconds < 9.95 else f"{seconds:.0f}"
        rows[case.name] = f"{text}\t{when}"
        TIMES.write_text("\n".join([head] + [f"{name}\t{row}" for name, row in sorted(rows.items())]) + "\n")


main()
