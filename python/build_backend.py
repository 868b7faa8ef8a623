"""Builds wheel and sdist of the Python module (PEP 517) with CMake, without network and without other packages.

The same source gives the same bytes: files are sorted, times are SOURCE_DATE_EPOCH (or 1980-01-01), owners are 0.
Settings (pip's --config-settings): build-dir=FOLDER takes the module from that CMake build instead of an own one."""
import base64
import gzip
import hashlib
import io
import os
import re
import subprocess
import sysconfig
import tarfile
import tempfile
import time
import tomllib
import zipfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FIRST_TIME = 315532800  # 1980-01-01, the first that a zip file can have
LEFT_OUT = {"build", "render", ".cache", ".git"}  # at the top


def source_time():
    return max(int(os.environ.get("SOURCE_DATE_EPOCH", FIRST_TIME)), FIRST_TIME)


def project():
    """The table [project] of pyproject.toml with the version of the library's header."""
    with open(os.path.join(ROOT, "pyproject.toml"), "rb") as file:
        table = tomllib.load(file)["project"]
    with open(os.path.join(ROOT, "include/velo/base.h"), encoding="utf-8") as file:
        text = file.read()
    parts = [re.search(rf"^#define VL_VERSION_{part} (\d+)$", text, re.M).group(1) for part in ("MAJOR", "MINOR", "PATCH")]
    table["version"] = ".".join(parts)
    return table


def metadata():
    table = project()
    with open(os.path.join(ROOT, table["readme"]), encoding="utf-8") as file:
        readme = file.read()
    return (f"Metadata-Version: 2.1\nName: {table['name']}\nVersion: {table['version']}\nSummary: {table['description']}\n"
            f"License: {table['license']['text']}\nRequires-Python: {table['requires-python']}\n"
            f"Description-Content-Type: text/markdown\n\n{readme}").encode()


# ---- sdist ----------------------------------------------------------------------------------------------------------


def source_files():
    """The files of the source: those that git knows, or all where there is no repository."""
    result = subprocess.run(["git", "-C", ROOT, "ls-files", "-z"], capture_output=True, check=False)
    own = subprocess.run(["git", "-C", ROOT, "rev-parse", "--show-cdup"], capture_output=True, text=True, check=False)
    if result.returncode == 0 and own.returncode == 0 and not own.stdout.strip():
        return sorted(name for name in result.stdout.decode().split("\0") if name)
    names = []
    for folder, folders, files in os.walk(ROOT):
        top = folder == ROOT
        folders[:] = [f for f in folders if f != "__pycache__" and not (top and (f in LEFT_OUT or f.startswith("obj-")))]
        names += [os.path.relpath(os.path.join(folder, file), ROOT) for file in files]
    return sorted(name for name in names if name != "PKG-INFO" and not name.endswith((".pyc", ".tmp")))


def build_sdist(sdist_directory, config_settings=None):
    table = project()
    name = f"{table['name']}-{table['version']}"
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode="w", format=tarfile.PAX_FORMAT) as tar:
        for path in source_files() + ["PKG-INFO"]:
            full = os.path.join(ROOT, path)
            info = tarfile.TarInfo(f"{name}/{path}")
            info.mtime = source_time()
            if path == "PKG-INFO":
                data = metadata()
            elif os.path.islink(full):
                info.type, info.linkname, data = tarfile.SYMTYPE, os.readlink(full), b""
            else:
                with open(full, "rb") as file:
                    data = file.read()
                info.mode = 0o755 if os.access(full, os.X_OK) else 0o644
            info.size = len(data)
            tar.addfile(info, io.BytesIO(data))
    with open(os.path.join(sdist_directory, name + ".tar.gz"), "wb") as file:
        with gzip.GzipFile(filename="", mode="wb", fileobj=file, mtime=0) as packed:
            packed.write(buffer.getvalue())
    return name + ".tar.gz"


# ---- wheel ----------------------------------------------------------------------------------------------------------


def build_module(folder, settings):
    """Builds the module and returns the folder that holds the package velo."""
    build = settings.get("build-dir")
    if not build:
        build = folder
        flags = os.environ.get("CFLAGS", "") + f" -ffile-prefix-map={build}=. -ffile-prefix-map={ROOT}=."
        subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DVELO_SHARED=OFF",
                        "-DVELO_PYTHON=ON", f"-DCMAKE_C_FLAGS={flags}", f"-DCMAKE_CXX_FLAGS={flags}",
                        "-DCMAKE_MODULE_LINKER_FLAGS=-s"], check=True)
    subprocess.run(["cmake", "--build", build, "--target", "velo_python"], check=True)
    return os.path.join(build, "python")


def stripped(path):
    """The contents of an extension without what only debuggers read: builds of packages have it."""
    with tempfile.TemporaryDirectory() as folder:
        result = os.path.join(folder, "stripped")
        subprocess.run(["strip", "-o", result, path], check=True)
        with open(result, "rb") as file:
            return file.read()


def package_files(folder):
    """{name in the wheel: contents}"""
    files = {}
    for place, _, names in os.walk(os.path.join(folder, "velo")):
        for name in names:
            if name.endswith((".py", ".pyi", ".so")) or name == "py.typed":
                path = os.path.join(place, name)
                with open(path, "rb") as file:
                    files[os.path.relpath(path, folder)] = stripped(path) if name.endswith(".so") else file.read()
    if not any(name.endswith(".abi3.so") for name in files):
        raise RuntimeError(f"no extension in {folder}")
    return files


def digest(data):
    return "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


def write_wheel(folder, base, tag, files):
    """Writes the wheel of these files ({name: contents}) with the descriptions that depend on tag and files; returns its name."""
    info = base + ".dist-info"
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: velo\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    files.pop(f"{info}/RECORD", None)
    record = "".join(f"{name},{digest(data)},{len(data)}\n" for name, data in sorted(files.items()))
    files[f"{info}/RECORD"] = f"{record}{info}/RECORD,,\n".encode()
    name = f"{base}-{tag}.whl"
    with zipfile.ZipFile(os.path.join(folder, name), "w", zipfile.ZIP_DEFLATED) as wheel:
        for path in sorted(files):
            entry = zipfile.ZipInfo(path, time.gmtime(source_time())[:6])
            entry.external_attr = (0o755 if ".so" in os.path.basename(path) else 0o644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, files[path])
    return name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    table = project()
    tag = "cp311-abi3-" + sysconfig.get_platform().replace("-", "_").replace(".", "_")
    base = f"{table['name']}-{table['version']}"
    with tempfile.TemporaryDirectory() as folder:
        files = package_files(build_module(folder, config_settings or {}))
    files[f"{base}.dist-info/METADATA"] = metadata()
    with open(os.path.join(ROOT, "LICENSE"), "rb") as file:
        files[f"{base}.dist-info/LICENSE"] = file.read()
    return write_wheel(wheel_directory, base, tag, files)
