#!/usr/bin/env python3
"""The Python package jsonschema validates JSON reports: usage json_schemas.py SCHEMA_FOLDER REPORT.json…

The name of a report up to its first dot names its schema: `measure.crossing.json` follows `measure.schema.json`.
"""

import importlib.metadata
import json
import sys
from pathlib import Path

import jsonschema


def main():
    folder, reports = Path(sys.argv[1]), [Path(name) for name in sys.argv[2:]]
    schemas = {path.name.split(".")[0]: json.loads(path.read_text()) for path in folder.glob("*.schema.json")}
    for schema in schemas.values():
        jsonschema.Draft202012Validator.check_schema(schema)
    for report in reports:
        validator = jsonschema.Draft202012Validator(schemas[report.name.split(".")[0]])
        for error in validator.iter_errors(json.loads(report.read_text())):
            sys.exit(f"{report}: {error.json_path}: {error.message}")
    version = importlib.metadata.version("jsonschema")
    print(f"jsonschema {version}: {len(schemas)} schemas and {len(reports)} reports are valid")


main()
