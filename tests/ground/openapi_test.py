#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""The station's OpenAPI document before a foreign judge, `openapi-spec-validator` from PyPI; and that the judge refuses a
damaged one.

    openapi_test.py FOLDER PROGRAM    PROGRAM --openapi prints the document; FOLDER is for a virtual environment

Exit code 77: the judge is neither here nor to be had."""
import json
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "client"))
from with_library import interpreter_or_skip  # noqa: E402

JUDGE = """
import json, sys
from openapi_spec_validator import validate
validate(json.load(sys.stdin))
"""


def judged(python, document):
    return subprocess.run([python, "-c", JUDGE], input=json.dumps(document), capture_output=True, text=True, check=False)


def main():
    folder, program = sys.argv[1:3]
    python = interpreter_or_skip(folder, "import openapi_spec_validator", HERE / "requirements.txt")
    document = json.loads(subprocess.run([program, "--openapi"], stdout=subprocess.PIPE, check=True).stdout)
    good = judged(python, document)
    if good.returncode != 0:
        sys.exit(good.stderr)
    document["paths"]["/api/status"]["get"]["responses"]["200"].pop("description")
    if judged(python, document).returncode == 0:
        sys.exit("the judge takes an answer without a description, too")


if __name__ == "__main__":
    main()
