#!/usr/bin/python3
"""test_enums.c misses no enum of the public API: each field of a struct that callers fill, and each function with such an
argument, is in it."""
import glob
import os
import re
import sys

ROOT = os.environ.get("VELO_SOURCE_DIR") or os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# What the library fills and callers only read; and of vlSceneDefs what no call of the library reads.
FILLED = {"vlError", "vlCamera", "vlCameraRecord", "vlFinding", "vlDrawingLine", "vlDrawingFace", "vlDrawingLabel",
          "vlPathVertex", "vlPathContribution", "vlParameter", "vlVanishingPoint", "vlSceneDefs"}
# Enums that are written as numbers: the type of the field does not tell.
NUMBERS = {"vlRenderDef.tracer", "vlRenderDef.sampler", "vlFilmDef.filter.kind", "vlShapeDef.kind",
           "vlCameraDef.projection", "vlCameraDef.distortion"}


def missing(headers, test):
    """Names of fields and functions of the headers that the test's text does not have."""
    text = re.sub(r"/\*.*?\*/", "", headers, flags=re.S)
    enums = "|".join(re.findall(r"typedef enum (\w+)", text))
    fields = set(NUMBERS)
    for struct, body in re.findall(r"(?:typedef )?struct (\w+) \{(.*?)\n\}", text, re.S):
        if struct not in FILLED:
            fields |= {"%s.%s" % (struct, name.strip()) for names in re.findall(r"\b(?:%s)\s+([\w ,]+);" % enums, body)
                       for name in names.split(",")}
    functions = {name for name, arguments in re.findall(r"VL_API\b[^;()]*?\b(\w+)\(([^;]*)\);", text)
                 if re.search(r"\b(?:%s) \w+" % enums, arguments)}
    has = {"%s.%s" % pair for pair in re.findall(r"FIELD\((\w+),\s*([\w.]+),", test)}
    return sorted(fields - has) + sorted(name for name in functions if not re.search(r"\b%s\(" % name, test))


def main():
    headers = "".join(open(path).read() for path in sorted(glob.glob(ROOT + "/include/velo/*.h")))
    test = open(ROOT + "/test/api/test_enums.c").read()
    left = missing(headers, test)
    for name in left:
        print("%s: an enum that test/api/test_enums.c does not try" % name)
    print("%s every_enum_is_tried" % ("not ok" if left else "ok"))
    tried = "typedef enum vlA { B } vlA;\ntypedef struct vlC {\n  vlA d, e;\n} vlC;\nVL_API int vl_f(int g, vlA h);\n"
    found = [name for name in missing(tried, "FIELD(vlC, d, try)") if name not in NUMBERS]
    print("%s a_new_enum_is_found" % ("ok" if found == ["vlC.e", "vl_f"] else "not ok"))
    return 1 if left or found != ["vlC.e", "vl_f"] else 0


sys.exit(main())
