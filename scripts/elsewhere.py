"""What build-page and build-win64 share: the core, compiled with the libraries that it wants, for another machine than
this one. LibYAML, SUNDIALS, LAPACK, Expat, zlib and f2c's library come as Debian's source packages, from the mirror
that apt knows, into BUILD/elsewhere; a second call fetches nothing. LAPACK is Fortran: f2c turns it into C, after what
it does not read (loops left by CYCLE and EXIT, three files of Fortran 90, inquiries of the arithmetic) is written in
Fortran 77 here.
"""
import glob
import os
import re
import shutil
import subprocess
import sys

HOME = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PROGRAM = os.path.basename(sys.argv[0])
BUILD = os.path.join(os.path.abspath(sys.argv[1] if len(sys.argv) == 2 else sys.exit(sys.modules["__main__"].__doc__)), "elsewhere")
SOURCE = f"{BUILD}/source"
PACKAGES = "libyaml sundials lapack expat zlib libf2c2".split()

# LAPACKE's functions that the core calls; what they call in turn is found by name.
LAPACKE = "dgebak dgebal dgeev dgehrd dgesv dgesvd dgetrf dgetrs dgtsv dhseqr dorghr dpotrf dpotrs dsyevx dsygvx".split()


def run(*words, **more):
    return subprocess.run(words, check=True, **more)


def need(program, package, setup):
    if not shutil.which(program):
        sys.exit(f"{PROGRAM}: no {program} here (Debian: scripts/setup {setup} installs {package})")


# ---- sources ----

def apt(*words):
    """apt-get on lists of its own, of source packages, from where the binary ones come."""
    folder = f"{BUILD}/apt"
    return run("apt-get", "-qq", "-o", f"Dir::Etc::sourcelist={folder}/sources.sources", "-o", "Dir::Etc::sourceparts=-",
               "-o", f"Dir::State::lists={folder}/lists", "-o", f"Dir::Cache={folder}", "-o", "APT::Sandbox::User=", *words,
               cwd=SOURCE, stdout=subprocess.DEVNULL)


def fetch():
    """The sources, once, each unpacked under its package's name."""
    missing = [name for name in PACKAGES if not os.path.isdir(f"{SOURCE}/{name}")]
    if not missing:
        return
    for folder in ("apt/lists/partial", "apt/archives/partial", "source"):
        os.makedirs(f"{BUILD}/{folder}", exist_ok=True)
    policy = run("apt-cache", "policy", "libyaml-dev", capture_output=True, text=True).stdout
    mirror = re.search(r"\d+ (https?://\S+) (\S+)/main", policy)
    with open(f"{BUILD}/apt/sources.sources", "w") as file:
        file.write(f"Types: deb-src\nURIs: {mirror[1]}\nSuites: {mirror[2]}\nComponents: main\n"
                   "Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg\n")
    apt("update")
    apt("source", "--download-only", *missing)
    for name in missing:
        package = glob.glob(f"{SOURCE}/{name}_*.dsc")[0]
        run("dpkg-source", "--no-check", "-x", package, f"{SOURCE}/{name}", stdout=subprocess.DEVNULL)


# ---- LAPACK in C ----

CONSTANTS = {"half": "0.5d0", "zero": "0.0d0", "one": "1.0d0", "maxn": "1.7976931348623157d308",
             "safmin": "2.2250738585072014d-308", "safmax": "4.49423283715579d307",
             "tsml": "1.4916681462400413d-154", "tbig": "1.997919072202235d146",
             "ssml": "4.4989137945431964d161", "sbig": "1.1113793747425387d-162"}
RELATIONS = {"==": ".EQ.", "/=": ".NE.", "<=": ".LE.", ">=": ".GE.", "<": ".LT.", ">": ".GT."}


def free_form(text, constants):
    """Fortran 90 as these three files have it: free lines, constants from a module, relations as signs."""
    text = re.sub(r"&\s*\n\s*", " ", "\n".join(line for line in text.split("\n") if not line.startswith("!")))
    text = re.sub(r"(?m)^\s*(use|intrinsic|integer, parameter|real\(wp\), parameter|implicit)\b.*\n", "", text)
    text = re.sub(r"\breal\(wp\) ::", "double precision", re.sub(r"integer ::", "integer", re.sub("logical ::", "logical", text)))
    text = re.sub("|".join(map(re.escape, RELATIONS)), lambda found: RELATIONS[found[0]], text)
    text = re.sub(r"(?i)LA_ISNAN\((\w+)\)", r"(\1 .NE. \1)", re.sub(r"end (subroutine|function).*", "end", text))
    out, declared = [], False
    for line in text.split("\n"):
        line = line.strip()
        if not declared and re.match(r"(double precision|integer)\b", line):
            out += [f"double precision {name}\n      parameter ({name} = {CONSTANTS[name]})" for name in constants]
            declared = True
        while len(line) > 60:
            cut = line.rindex(" ", 0, 60)
            out.append(line[:cut])
            line = "&" + line[cut:]
        out.append(line)
    return "".join(f"     {line}\n" if line.startswith("&") else f"      {line}\n" for line in out)


def leave_loops(text):
    """CYCLE and EXIT as jumps to the end of their DO loops, which get labels where they have none."""
    lines, loops, fresh = text.split("\n"), [], iter(range(90000, 99999))
    for i, line in enumerate(lines):
        if line[:1] in "cC*!":
            continue
        label, code = line[:5].strip(), line[6:].strip().upper()
        begun = re.match(r"DO\b\s*(\d*)", code)
        if begun:
            loops.append({"label": begun[1]})
        leave = re.search(r"\b(CYCLE|EXIT)$", code)
        if leave:
            where = loops[-1].setdefault(leave[1], (leave[1] == "CYCLE" and loops[-1]["label"]) or str(next(fresh)))
            lines[i] = re.sub(r"(?i)\b(CYCLE|EXIT)\s*$", f"GOTO {where}", line)
        while loops and (loops[-1]["label"] == label if label else re.match(r"END\s*DO\b", code) and not loops[-1]["label"]):
            loop = loops.pop()
            if "CYCLE" in loop and not label:
                lines[i] = f"{loop['CYCLE']:>5} CONTINUE\n{lines[i]}"
            if "EXIT" in loop:
                lines[i] += f"\n{loop['EXIT']:>5} CONTINUE"
            if not label:
                break
    return "\n".join(lines)


INQUIRIES = {r"EPSILON\(ZERO\)": "2.220446049250313D-16", r"TINY\(ZERO\)": "2.2250738585072014D-308",
             r"HUGE\(ZERO\)": "1.7976931348623157D308", r"RADIX\(ZERO\)": "2", r"DIGITS\(ZERO\)": "53",
             r"MINEXPONENT\(ZERO\)": "-1021", r"MAXEXPONENT\(ZERO\)": "1024",
             r"INTRINSIC.*\n.*TINY *\n": "EXTERNAL LSAME\n", r"EXTERNAL +LSAME *\n": "\n"}


def fortran_77(path):
    with open(path) as file:
        text = file.read()
    name = os.path.basename(path).split(".")[0]
    if path.endswith(".f90"):
        used = re.findall(r"\w+", text.lower())
        return free_form(text, [constant for constant in CONSTANTS if constant in used])
    if name == "dlamch":
        text = "\n".join(line for line in text.split("\n") if line[:1] != "*")
        for inquiry, value in reversed(INQUIRIES.items()):
            text = re.sub(f"(?i){inquiry}", value, text)
    text = re.sub(r"(?i), *INTENT\(\w+\) *::", " ", re.sub(r"(?im)^ +RECURSIVE ", "      ", text))
    return leave_loops(text)


def translate(path, into):
    """One file by f2c: a subroutine returns nothing, as LAPACKE declares it, for WebAssembly compares signatures."""
    text = subprocess.run(("f2c", "-a", "-A", "-w8"), input=fortran_77(path), capture_output=True, text=True)
    if text.returncode:
        sys.exit(f"{PROGRAM}: f2c does not read {path}: {text.stderr}")
    code = re.sub(r"/\* Subroutine \*/ int", "void", text.stdout).replace("return 0;", "return;")
    with open(into, "w") as file:
        file.write(code)


def lapack():
    """The C files of what LAPACKE's functions call, found from name to name."""
    home, folder = f"{SOURCE}/lapack", f"{BUILD}/lapack"
    found = {}
    for path in [f for place in ("BLAS/SRC", "SRC", "INSTALL") for kind in ("f", "f90") for f in glob.glob(f"{home}/{place}/*.{kind}")]:
        found.setdefault(os.path.basename(path).split(".")[0], path)
    os.makedirs(folder, exist_ok=True)
    files, todo, seen = [], ["ilaver"] + LAPACKE, {"xerbla"}
    for name in LAPACKE:
        files += glob.glob(f"{home}/LAPACKE/src/lapacke_{name}.c") + glob.glob(f"{home}/LAPACKE/src/lapacke_{name}_work.c")
    files += glob.glob(f"{home}/LAPACKE/utils/lapacke_d*_nancheck.c") + glob.glob(f"{home}/LAPACKE/utils/lapacke_d*_trans.c")
    files += [f"{home}/LAPACKE/{name}.c" for name in ("src/lapacke_nancheck", "utils/lapacke_xerbla")]
    # its own lsame_ takes two arguments more than that of LAPACK
    with open(f"{home}/LAPACKE/utils/lapacke_lsame.c") as file:
        text = "#define LAPACK_GLOBAL(lower, UPPER) other_##lower\n" + file.read().replace("return (lapack_logical) LAPACK_lsame(", "int lsame_(char *, char *, long, long);\n    return lsame_(")
    files.append(f"{folder}/lapacke_lsame.c")
    if not os.path.exists(files[-1]):
        with open(files[-1], "w") as file:
            file.write(text)
    while todo:
        name = todo.pop()
        if name in seen or name not in found:
            continue
        seen.add(name)
        into = f"{folder}/{name}.c"
        if not os.path.exists(into):
            translate(found[name], into)
        files.append(into)
        with open(into) as file:
            todo += re.findall(r"\b(\w+)_\(", file.read())
    return files


# ---- the core ----

FOLDERS = "base math model integration environment elements systems quantities state flight launch run scenario".split()
LEFT_OUT = ("_avx", "avx2", "avx512", "base_fmu.c")


def core(more, left_out=()):
    """Its files, and `more`; a launch without imported FMUs, on lanes of one."""
    files = [f for folder in FOLDERS for f in glob.glob(f"{HOME}/src/{folder}/**/*.c", recursive=True)]
    return [f for f in files if not any(part in f for part in LEFT_OUT + tuple(left_out))] + [f"{HOME}/src/{name}" for name in more]


# ---- compiling ----

def headers():
    """What the sources include of others': headers of Debian's packages for the native build, which have nothing of the machine."""
    folder = f"{BUILD}/include"
    os.makedirs(folder, exist_ok=True)
    wanted = "sundials arkode nvector Random123 lapacke.h lapacke_config.h lapacke_mangling.h " \
             "lapacke_utils.h lapack.h yaml.h expat.h expat_external.h zlib.h zconf.h f2c.h"
    for name in wanted.split():
        if not os.path.lexists(f"{folder}/{name}"):
            os.symlink(f"/usr/include/{name}", f"{folder}/{name}")
    with open(f"{folder}/expat_config.h", "w") as file:
        file.write("#define HAVE_MEMMOVE 1\n#define BYTEORDER 1234\n#define XML_NS 1\n#define XML_DTD 1\n"
                   "#define XML_CONTEXT_BYTES 1024\n#define XML_POOR_ENTROPY 1\n")
    return folder


def others():
    """Files of the libraries, with what each wants to be told."""
    home = SOURCE
    wanted = re.compile(r"arkode(_adapt|_butcher\w*|_erkstep\w*|_interp|_io|_root|_relaxation)?|sundials_(?!profiler|direct|dense|band|iterative|xbraid)\w+|nvector_serial")
    for path in [f for part in ("arkode", "sundials", "nvector/serial") for f in glob.glob(f"{home}/sundials/src/{part}/*.c")]:
        if wanted.fullmatch(os.path.basename(path)[:-2]):
            yield path, f"-I{home}/sundials/src/sundials -I{home}/sundials/src/arkode -I{home}/sundials/include"
    for path in glob.glob(f"{home}/libyaml/src/*.c"):
        yield path, f"-I{home}/libyaml/include {yaml_version(home)}"
    for name in ("xmlparse", "xmltok", "xmlrole"):
        yield f"{home}/expat/expat/lib/{name}.c", "-w"
    for name in ("adler32", "compress", "crc32", "deflate", "trees", "zutil"):
        yield f"{home}/zlib/{name}.c", "-w"
    for path in lapack():
        yield path, f"-I{home}/lapack/LAPACKE/include -w"
    for name in ("d_sign", "i_nint", "i_dnnt", "pow_di", "pow_dd", "pow_ii", "d_lg10", "r_lg10", "s_cmp", "s_copy", "s_cat", "i_len", "d_int", "d_nint"):
        if os.path.exists(f"{home}/libf2c2/{name}.c"):
            yield f"{home}/libf2c2/{name}.c", "-w -DNO_OVERWRITE"


def yaml_version(home):
    with open(f"{home}/libyaml/CMakeLists.txt") as file:
        text = file.read()
    parts = [re.search(rf"YAML_VERSION_{part} (\d+)", text)[1] for part in ("MAJOR", "MINOR", "PATCH")]
    return " ".join([f"-DYAML_VERSION_{part}={value}" for part, value in zip(("MAJOR", "MINOR", "PATCH"), parts)]
                    + [f"-DYAML_VERSION_STRING='\"{'.'.join(parts)}\"'"])


def compile_all(into, compiler, flags, files, target, link, needs=()):
    """By ninja, which compiles what has changed, in the folder `into`: `target`, of files of the core and of libraries,
    each with its own flags."""
    include = headers()
    os.makedirs(into, exist_ok=True)
    with open(f"{into}/build.ninja", "w") as ninja:
        ninja.write(f"rule cc\n  command = {compiler} {flags} $flags -I{include} -MD -MF $out.d -c $in -o $out\n  depfile = $out.d\n"
                    f"rule link\n  command = {link}\n  rspfile = $out.rsp\n  rspfile_content = $in\n")
        objects = []
        for path, own in files:
            name = os.path.relpath(path, BUILD if path.startswith(BUILD) else into if path.startswith(into) else HOME)
            objects.append("object/" + name.replace("/", "_") + ".o")
            ninja.write(f"build {objects[-1]}: cc {path}\n  flags = {own}\n")
        ninja.write(f"build {target}: link {' '.join(objects)} | {' '.join(needs)}\n")
    run("ninja", "-j", str(os.cpu_count()), "-C", into, target.split()[0], env=dict(os.environ, NODE_PATH="/usr/share/nodejs"), stdout=sys.stderr)
