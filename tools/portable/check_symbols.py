#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""check_symbols.py BUILD: what our objects want of the system, against the interfaces of POSIX.1-2008 (docs/adr/0097).

Looks at the undefined symbols of the framework's libraries as they stand in the build folder: those that every backend shares, and
what takes the place of the files that need Linux. The list of interfaces is what the system's own headers declare with
_POSIX_C_SOURCE=200809L and nothing else, in C17: by the standard (2.2.1) that is POSIX.1-2008 and ISO C. No list is kept here that could
grow old. What is left is the compiler's own run-time library, ours, and the two libraries that we stand on."""
import pathlib
import re
import subprocess
import sys
import tempfile

# XBD chapter 13 of the standard, without those of its options that nobody here uses.
HEADERS = """aio arpa/inet assert complex ctype dirent dlfcn errno fcntl fenv fnmatch glob grp inttypes langinfo limits locale math
monetary mqueue net/if netdb netinet/in netinet/tcp nl_types poll pthread pwd regex sched semaphore setjmp signal stdarg stdio stdlib string
strings sys/mman sys/select sys/socket sys/stat sys/statvfs sys/times sys/types sys/un sys/utsname sys/wait tar termios time unistd wchar
wctype wordexp""".split()
# The compiler's run time: the C++ ABI, unwinding, libgcc, atomics, stack protection, thread-local storage, the linker's own marks.
RUNTIME = re.compile(r"^(__cxa_\w+|_Unwind_\w+|__gxx_personality_v0|__dso_handle|__gcc_personality_v0|__stack_chk_fail|__tls_get_addr|"
                     r"_GLOBAL_OFFSET_TABLE_|__dynamic_cast|__atomic_\w+|__(u?div|u?mod|mul|popcount|clz|ctz|parity)\w*[dst]i\d|__ubsan_\w+|__[at]san_\w+)$")
# C++ names: the standard library's (also in its own inline namespaces), operators new and delete, type information of built-in types.
CXX_LIBRARY = re.compile(r"^(_ZN?K?V?S[abdiost]|_ZN?K?St|_ZT[ISVT]\w*St|_ZT[IS]|_ZTV\w*__cxxabiv1|_Zn[wa]|_Zd[la]|_ZSt|_ZNK?10__cxxabiv1|_ZGTt|"
                         r"_ZNK?9__gnu_cxx|_ZTHN?St|_ZNK?S[abdiost])")
OURS = re.compile(r"^_ZT?[A-Z]*N?[KV]*(?:[A-Z]\w*?)?7hirosco|7hirosco")
BELOW = re.compile(r"^XML_|3fmt")    # Expat, fmt
# How this C library spells what the standard has as a macro, or as an interface under another name.
SPELT = {"__errno_location": "errno", "__assert_fail": "assert", "___errno_location": "errno", "__sigsetjmp": "sigsetjmp",
         "__isoc23_strtol": "strtol", "__isoc23_strtoul": "strtoul", "__isoc23_strtoll": "strtoll", "__isoc23_strtoull": "strtoull",
         "__libc_single_threaded": "", "__cmsg_nxthdr": "CMSG_NXTHDR", "__ctype_b_loc": "isalnum", "__ctype_tolower_loc": "tolower",
         "__ctype_toupper_loc": "toupper", "__fdelt_chk": "FD_SET", "environ": "environ", "__sysconf": "sysconf"}
# What is not to be found in the list, or the list is of no use: extensions of Linux, of the BSDs and of the GNU library.
PLANTED = "accept4 epoll_wait eventfd gettid memfd_create pipe2 ppoll prctl pthread_setname_np recvmmsg signalfd syscall".split()
# Of the default build: what HIROSCO_OS=linux has by itself, so that it is not looked at here.
OF_LINUX = {"socket_channel.cpp.o", "linux_flow_means.cpp.o", "framed_stream.cpp.o", "message_queue_flow.cpp.o", "private_memory_folder.cpp.o", "serial_flow.cpp.o",
            "shared_memory_flow.cpp.o", "side_lock.cpp.o", "tcp_flow.cpp.o", "linux_mechanisms.cpp.o", "udp_link.cpp.o", "sealed_memory.cpp.o", "run.cpp.o"}
LIBRARIES = "utilities_portable data_transfer_portable resource xml parameter data_transfer descriptor pus subsystem".split()
OF_POSIX = "utilities resource xml parameter data_transfer descriptor pus subsystem".split()


def interfaces(compiler):
    """Names that the headers declare."""
    with tempfile.TemporaryDirectory() as folder:
        source, found = pathlib.Path(folder) / "all.c", pathlib.Path(folder) / "declared"
        source.write_text("".join(f"#include <{name}.h>\n" for name in HEADERS))
        subprocess.run([compiler, "-std=c17", "-D_POSIX_C_SOURCE=200809L", "-fsyntax-only", "-aux-info", found, source], check=True)
        names = set(re.findall(r"\b(\w+) \(", found.read_text()))
    return names | {"environ", "stdin", "stdout", "stderr", "signgam", "timezone", "tzname", "daylight"}


def undefined(archive):
    """{symbol: [objects]} of an archive, but for the objects that need Linux."""
    wanted, name = {}, ""
    for line in subprocess.run(["nm", "--undefined-only", archive], check=True, capture_output=True, text=True).stdout.splitlines():
        if line.endswith(":"):
            name = line[:-1]
        elif line.strip() and name not in OF_LINUX and line.split()[-2] == "U":    # a weak one may be missing
            wanted.setdefault(line.split()[-1].split("@")[0], []).append(f"{archive.name}:{name}")
    return wanted


def foreign(symbols, posix):
    """Those that are neither of the standards nor of what we bring along."""
    return {symbol: where for symbol, where in symbols.items()
            if symbol not in posix and SPELT.get(symbol, None) not in posix | {""}
            and not any(rule.search(symbol) for rule in (RUNTIME, CXX_LIBRARY, OURS, BELOW))}


def main():
    build = pathlib.Path(sys.argv[1])
    posix = interfaces("cc")
    seen = [name for name in PLANTED if name not in foreign({name: []}, posix)]
    if seen or len(posix) < 800:
        sys.exit(f"the list of interfaces is of no use: {len(posix)} names, among them {seen}")
    libraries = LIBRARIES if (build / "hirosco/utilities/libhirosco_utilities_portable.a").exists() else OF_POSIX
    found, looked_at = {}, set()
    for library in libraries:
        archive, = build.glob(f"hirosco/*/libhirosco_{library}.a")
        symbols = undefined(archive)
        looked_at |= symbols.keys()
        for symbol, where in foreign(symbols, posix).items():
            found.setdefault(symbol, []).extend(where)
    for symbol, where in sorted(found.items()):
        print(f"{symbol} is no interface of POSIX.1-2008: {', '.join(where)}")
    used = sorted(symbol for symbol in looked_at if symbol in posix)
    print(f"{len(looked_at)} symbols of {len(libraries)} libraries, {len(used)} of them interfaces of POSIX.1-2008 and ISO C "
          f"(of {len(posix)} that the headers declare)")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
