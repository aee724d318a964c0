#!/usr/bin/env python3
"""Whether `ayumi selftest` gives one set of hashes, whatever computes it.

    tests/one_hash.py [--build build/release]            settings of the machine
    tests/one_hash.py [--build …] --compiler 'g++ -O0' [--no-avx2]  another compiler or other options
    tests/one_hash.py [--build …] --libraries FOLDER [--link OPTION]  libraries of another build

The settings are 1 to 8 threads; the C library without fused multiply-add, AVX2, AVX and SSE 4, with
the BLAS kernels for such a processor; and the locales de_DE and tr_TR with time zones far away. The
locales are made by localedef (Debian package locales), as few machines have them.

With --compiler, the libraries core and repair, which compute all numbers, are compiled again with
this compiler and these options, and are linked with the other parts of the finished build. (The
other parts read files, write texts and draw.) With --no-avx2, their kernels use SSE2 alone. With
--libraries, those of the two that are in FOLDER are taken from there; the linker may need an option
for them (--link=--coverage). The build folder itself does not change. The exit code is 1 where a
hash differs.
"""
import argparse
import os
import shlex
import subprocess
import sys
import tempfile

SOURCE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
ROOMS = ["core", "repair"]


def same(program, what, options=(), **environment):
    """Whether the program gives the published hashes; says so."""
    done = subprocess.run([program, "selftest", *options], env={**os.environ, **environment},
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    print(f"{'same' if done.returncode == 0 else 'DIFFERENT'}: {what}", flush=True)
    if done.returncode != 0:
        print(done.stdout)
    return done.returncode == 0


def commands_for(build, target):
    said = subprocess.run(["ninja", "-C", build, "-t", "commands", target], check=True,
                          stdout=subprocess.PIPE, text=True).stdout
    return said.splitlines()


def compiled_again(build, room, compiler, avx2, folder):
    """The library of the room, compiled by another compiler or with other options."""
    objects = []
    for line in commands_for(build, f"lib/libayumi_{room}.a"):
        words = [word for word in shlex.split(line) if not word.endswith("ccache")]
        if "-c" not in words or f"/ayumi_{room}" not in words[words.index("-o") + 1]:
            continue  # headers that are precompiled, and other libraries
        source = words[words.index("-c") + 1]
        kept = []
        for word, after in zip(words[1:words.index("-MD")], words[2:]):
            if word == "-include":
                # It is a copy without a precompiled form beside it.
                copy = os.path.join(folder, after.split("/")[-2] + ".hxx")
                with open(after) as header, open(copy, "w") as file:
                    file.write(header.read())
                kept += ["-include", copy]
            elif word == "-isystem":
                kept += ["-isystem", after]
            elif word.startswith(("-I", "-D", "-f", "-std=")) or word == "-mavx2" and avx2:
                kept.append(word)
        objects.append(os.path.join(folder, f"{room}_{len(objects)}.o"))
        subprocess.run([*shlex.split(compiler), *kept, "-w", "-o", objects[-1], "-c", source],
                       cwd=build, check=True)
    library = os.path.join(folder, f"libayumi_{room}.a")
    subprocess.run(["ar", "qcs", library, *objects], check=True)
    return library


def linked(build, libraries, options, folder):
    line = commands_for(build, "app/ayumi")[-1]
    words = shlex.split(line.removeprefix(": && ").split(" && ")[0])
    program = os.path.join(folder, "ayumi")
    words[words.index("-o") + 1] = program
    for room, library in libraries.items():
        name = f"libayumi_{room}.a"
        words = [",".join(library if part.endswith(f"lib/{name}") else part
                          for part in word.split(",")) for word in words]
    subprocess.run(words + options, cwd=build, check=True)
    return program


def with_settings(program, folder):
    good = True
    for threads in range(1, 9):
        good &= same(program, f"{threads} thread{'s' if threads > 1 else ''}", ["--threads", str(threads)])
    without = "-FMA,-FMA4,-AVX2,-AVX2_Usable,-FMA_Usable"
    good &= same(program, "C library without FMA and AVX2", OPENBLAS_CORETYPE="Nehalem",
                 GLIBC_TUNABLES=f"glibc.cpu.hwcaps={without}")
    good &= same(program, "C library without FMA, AVX and SSE 4", OPENBLAS_CORETYPE="Prescott",
                 GLIBC_TUNABLES=f"glibc.cpu.hwcaps={without},-AVX,-SSE4_1,-SSE4_2")
    for locale, zone in [("de_DE", "Pacific/Chatham"), ("tr_TR", "Pacific/Apia")]:
        place = os.path.join(folder, f"{locale}.UTF-8")
        try:
            subprocess.run(["localedef", "-i", locale, "-f", "UTF-8", place], check=True)
        except (OSError, subprocess.CalledProcessError):
            print(f"not tried: locale {locale}, which cannot be made here (Debian package locales)")
            continue
        good &= same(program, f"locale {locale}, time zone {zone}", LOCPATH=folder,
                     LC_ALL=f"{locale}.UTF-8", TZ=zone)
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=os.path.join(SOURCE, "build", "release"))
    parser.add_argument("--compiler", help="with its options")
    parser.add_argument("--no-avx2", action="store_true")
    parser.add_argument("--libraries", help="folder of libayumi_core.a, libayumi_repair.a or both")
    parser.add_argument("--link", action="append", default=[], help="an option of the linker")
    options = parser.parse_args()
    build = os.path.abspath(options.build)
    with tempfile.TemporaryDirectory(prefix="ayumi_one_hash_") as folder:
        if options.libraries:
            files = {room: os.path.join(os.path.abspath(options.libraries), f"libayumi_{room}.a")
                     for room in ROOMS}
            libraries = {room: file for room, file in files.items() if os.path.exists(file)}
            if not libraries:
                sys.exit(f"{options.libraries} contains neither library")
            good = same(linked(build, libraries, options.link, folder),
                        f"{' and '.join(libraries)} of {options.libraries}")
        elif options.compiler or options.no_avx2:
            compiler = options.compiler or "c++ -O3"
            libraries = {room: compiled_again(build, room, compiler, not options.no_avx2, folder)
                         for room in ROOMS}
            good = same(linked(build, libraries, options.link, folder),
                        f"{compiler}{', SSE2 alone' if options.no_avx2 else ''}")
        else:
            good = with_settings(os.path.join(build, "app", "ayumi"), folder)
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
