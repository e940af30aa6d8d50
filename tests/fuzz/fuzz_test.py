#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""A fuzz target under libFuzzer, ASan and UBSan: as many inputs as it is given, from its corpus on, break nothing; and each
planted defect is found, so that the target can see. fuzz_test.py arguments BUILD-FOLDER [--runs N]. Skipped
where there is no clang with libFuzzer (tools/skip_reason). Of targets that need whole libraries there is none: README.md."""
import argparse, pathlib, re, shutil, subprocess, sys, tempfile
import seeds

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
COMPILERS = ("clang++-19", "clang++")
FLAGS = ["-std=c++23", "-O1", "-g1", "-fsanitize=fuzzer,address,undefined", "-fno-sanitize-recover=all", f"-I{ROOT}"]
LONGEST_INPUT = 400
MOST_RUNS_WITH_A_DEFECT = 2_000_000
ARGUMENTS = "hirosco/pus/service/arguments.cpp"
PACKET, CUC = "hirosco/pus/packet/packet.cpp", "hirosco/pus/packet/cuc.cpp"
DOWNLINK = "ground/downlink/downlink.cpp"
EVENT = "hirosco/pus/st05_event/event_message.cpp"
SUPERVISION = "hirosco/pus/st129_supervision/supervision_messages.cpp"
HANDSHAKE = "hirosco/pus/st128_realtime_link/link_handshake_octets.cpp"
DEVICE, ENABLE, POWER = (f"hirosco/data_transfer/device/{name}_frame.cpp" for name in ("device", "enable", "power"))
NETWORK, LOCK = "hirosco/data_transfer/device/device_network.cpp", "tools/hirosco/flight_lock.cpp"
FRAMES = "hirosco/data_transfer/channel/stream_frame.cpp"
DATAGRAMS = "hirosco/data_transfer/link/link_datagram.cpp"
STREAMS = "hirosco/data_transfer/device/stream_framing.cpp"
DICTIONARY = "hirosco/parameter/dictionary.cpp"
PARAMETERS = "hirosco/pus/st20_parameter/parameter_service.cpp"
URDF = "robotics/urdf/read.cpp"
URDF_TREE = "robotics/urdf/connect.cpp"
MESH, COLLADA = "robotics/shapes/mesh.cpp", "robotics/shapes/collada.cpp"
SCREEN = "tools/terminal/screen.cpp"
SCREEN_MODEL = "tools/terminal/screen_model.cpp"
# What a target needs of the system besides the C++ library.
SYSTEM = {"mesh": ["-isystem", "/usr/include/eigen3", "-lexpat"], "urdf": ["-isystem", "/usr/include/eigen3", "-lexpat"], "screen": ["-lfmt"], "words": ["-lfmt"]}
# The files of a target, and its defects: what stands in a file, and what does in its place.
TARGETS = {"arguments": (
    [ARGUMENTS, "hirosco/pus/st08_function/function_service.cpp", "hirosco/pus/st01_verification/verification.cpp",
     "hirosco/pus/packet/packet.cpp", "hirosco/pus/packet/cuc.cpp", "hirosco/parameter/exact_number.cpp"],
    {"a text may be longer than declared":
         (ARGUMENTS, "return text.size() <= argument.field.text_octets && is_text(text);", "return is_text(text);"),
     "the last element of an array has no range":
         (ARGUMENTS, "good = permits(argument, read_number(reader, argument.field.type)) && good;",
          "good = permits(argument, read_number(reader, argument.field.type)) && (good || i + 1 == argument.field.count);"),
     "an argument that is given twice counts":
         ("hirosco/pus/st08_function/function_service.cpp", " && taken_[id - 1].empty();", ";")}),
    "packets": (
    [PACKET, CUC, DOWNLINK],
    {"a packet may be shorter than it says":
         (PACKET, "announced_octets(packet) != packet.size())\n    return std::unexpected", "announced_octets(packet) < packet.size())\n    return std::unexpected"),
     "a telecommand may be of another version":
         (PACKET, "if (u8_at(packet, 6) >> 4 != pus_version) return refuse(IllegalPusVersion);", ""),
     "a report is taken before its last octet is there":
         (DOWNLINK, "if (!good || rest.size() < size) break;", "if (!good || rest.size() + 1 < size) break;")}),
    "messages": (
    [EVENT, SUPERVISION, HANDSHAKE, "hirosco/pus/st128_realtime_link/link_handshake.cpp", "hirosco/data_transfer/wire_layout.cpp", PACKET, CUC],
    {"an octet behind words is read":
         (SUPERVISION, "return {reinterpret_cast<const char*>(words.data()), words.size()};", "return {reinterpret_cast<const char*>(words.data()), words.size() + 1};"),
     "something may stand behind a problem of a descriptor":
         (SUPERVISION, "return reader.exhausted() ? std::optional{std::move(problem)}", "return reader.good() ? std::optional{std::move(problem)}"),
     "a consumer is woken by a switch that is none":
         (HANDSHAKE, "require(is_depth(samples, queued) && flag <= 1);", "require(is_depth(samples, queued));"),
     "an offer may be of another link than its request":
         (HANDSHAKE, "reader.require(link_of_offer == message.link);", ""),
     "an event's data begin in its number":
         (EVENT, "octets.subspan(event_message_head_octets)", "octets.subspan(event_message_head_octets - 1)")}),
    "device_frames": (
    [DEVICE, ENABLE, POWER],
    {"ends that are swapped understand each other":
         (DEVICE, 'if (found_kind != static_cast<std::uint8_t>(kind)) return fail(ErrorCode::Malformed, "device frame kind", found_kind);', ""),
     "a frame may be longer than it says":
         (DEVICE, "if (payload_octets != octets.size() - device_frame_overhead_octets)", "if (payload_octets > octets.size() - device_frame_overhead_octets)"),
     "something may stand behind the frame of an inhibit":
         (ENABLE, "if (octets.size() != enable_frame_octets)", "if (octets.size() < enable_frame_octets)"),
     "a switch of power goes off before it is on":
         (POWER, 'if (found.off_after_ms == 0) return fail(ErrorCode::Malformed, "power frame time", 0);', "")}),
    "words": (
    ["hirosco/data_transfer/address/internet_address.cpp", NETWORK, "hirosco/data_transfer/device/serial_line.cpp", "hirosco/parameter/exact_number.cpp", LOCK],
    {"a network may have bits behind its prefix":
         (NETWORK, "if (!made.contains(made.network))", "if (made.prefix == 0)"),
     "a flight may be of no process":
         (LOCK, "lock.keeper <= 0", "lock.keeper < 0")}),
    "parameters": (
    [DICTIONARY, PARAMETERS, "hirosco/pus/st01_verification/verification.cpp", "hirosco/pus/packet/packet.cpp",
     "hirosco/pus/packet/cuc.cpp", "hirosco/parameter/exact_number.cpp", "hirosco/parameter/native_layout.cpp",
     "hirosco/parameter/parameter.cpp"],
    {"a switch may be neither on nor off":
         (DICTIONARY, "return octet == std::byte{0} || octet == std::byte{1};", "return octet != std::byte{0xFF};"),
     "something may stand behind the end of words":
         (DICTIONARY, "return is_fixed_text(octets);", "return is_text(fixed_words(octets));"),
     "a request whose last value is refused sets the others":
         (PARAMETERS, "    good = false;\n", "    good = i + 1 == asked.size();\n")}),
    "stream_frame": (
    [FRAMES],
    {"the check sum is not looked at":
         (FRAMES, "if (crc16(received.first(checked)) != sum)", "if (checked == 0)"),
     "a frame may be longer than there is room for":
         (FRAMES, "if (payload > max_stream_frame_payload)\n    return fail(ErrorCode::Malformed",
          "if (payload > 0xFFFF)\n    return fail(ErrorCode::Malformed"),
     "a frame is taken before its last octet is there":
         (FRAMES, "if (received.size() < whole)", "if (received.size() + 1 < whole)"),
     "there is a fourth kind of frame":
         (FRAMES, "kind > static_cast<std::uint8_t>(StreamFrameKind::Permit)",
          "kind > static_cast<std::uint8_t>(StreamFrameKind::Permit) + 1")}),
    "stream_framing": (
    [STREAMS],
    {"the check of a frame is not looked at":
         (STREAMS, "if (check.get<std::uint16_t>() == crc16(frame)) {", "if (check.get<std::uint16_t>() != 0x5A5A) {"),
     "a head may promise more than a frame can have":
         (STREAMS, "sync == stream_sync && octets <= max_frame_octets &&", "sync == stream_sync &&"),
     "a head is not checked":
         (STREAMS, " && check == crc16(head.first(checked_head_octets))", " && check != 0xFFFF"),
     "a frame is taken before its last octet is there":
         (STREAMS, "if (waiting.size() < whole)", "if (waiting.size() + 1 < whole)")}),
    "link_datagram": (
    [DATAGRAMS],
    {"the check sum is not looked at":
         (DATAGRAMS, " || crc16(received) != 0)", ")"),
     "a datagram may be longer than it says":
         (DATAGRAMS, "payload.size() != said.payload_octets", "payload.size() < said.payload_octets"),
     "a datagram is taken twice":
         (DATAGRAMS, "head.sequence <= last_.sequence", "head.sequence < last_.sequence"),
     "an earlier sample replaces a later one":
         (DATAGRAMS, " || head.count < last_.count)", ")"),
     "a status that no producer has is handed on":
         (DATAGRAMS, "status > worst", "status > worst + 1"),
     "what another handshake agreed on is taken":
         (DATAGRAMS, "if (said != agreed_)", "if (said.link != agreed_.link)")}),
    "urdf": (
    [URDF, URDF_TREE, "robotics/urdf/describe.cpp", "robotics/urdf/words.cpp", "robotics/dynamics/model.cpp", "robotics/dynamics/dynamics.cpp", "hirosco/xml/reader.cpp"],
    {"the lower limit may be above the upper one":
         (URDF, "if (*limits.lower > *limits.upper)", "if (*limits.lower > *limits.upper + 1)"),
     "damping may drive a joint":
         (URDF, "if (*to < 0)", "if (*to < -1)"),
     "a joint may never speed up":
         (URDF, "if (told && !(*told > 0))", "if (told && *told < 0)"),
     "an inertia may be that of no body":
         (URDF_TREE, "if (is_body(body)) return;", "if (body.mass >= 0) return;"),
     "a mimic joint follows the first joint, whomever it names":
         (URDF_TREE, "whole.joint = found->second;", "whole.joint = 0;"),
     "a second link of a name is taken":
         (URDF_TREE, "if (!is_new)", "if (!is_new && list.size() > 9)")}),
    "mesh": (
    [MESH, COLLADA, "hirosco/xml/reader.cpp"],
    {"a corner of a face may be a point that there is not":
         (MESH, "at < 0 || at >= points", "at < 0 || at > points"),
     "a corner of a triangle may be a point that there is not":
         (COLLADA, "if ((*numbers)[i] >= mesh_.points.size() - first)", "if ((*numbers)[i] > mesh_.points.size() - first)"),
     "what is written as STL has another corner":
         (MESH, "detail::put_point(mesh.points[corner], octets)", "detail::put_point(mesh.points[std::min(corner, triangle[0])], octets)"),
     "a polygon may be longer than what is left":
         (COLLADA, "if (count > corners.size() - at)", "if (count > corners.size() - at + 1)")}),
    "screen": (
    [SCREEN, SCREEN_MODEL, "tools/terminal/columns.cpp", "tools/terminal/verdict.cpp", "hirosco/descriptor/model/find.cpp"],
    {"a row may be wider than the terminal":
         (SCREEN, "cut(text, columns_ - used_)", "cut(text, columns_)"),
     "a value may be of any kind":
         (SCREEN_MODEL, "one.size() == 2 && one[0].is_string() && one[1].is_string()", "one.size() == 2"),
     "a key that is none takes nothing":
         (SCREEN_MODEL, "  octets.remove_prefix(1);\n  switch (first) {", "  if (first != 'x') octets.remove_prefix(1);\n  switch (first) {")})}


def compiler():
    """One that has libFuzzer, None when there is none."""
    for name in filter(shutil.which, COMPILERS):
        tried = subprocess.run([name, "-fsanitize=fuzzer", "-x", "c++", "-", "-o", "/dev/null"], capture_output=True, check=False,
                               input=b'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }')
        if tried.returncode == 0:
            return name
    return None


def built(name, sources, program, system):
    """Sources are compiled anew; the library's headers may have changed since."""
    done = subprocess.run([name, *FLAGS, *map(str, sources), *system, "-o", str(program)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"cannot be built:\n{done.stderr[-4000:]}")
    return program


def fuzz(program, corpus, runs):
    """What it says, when it found something."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([program, f"-runs={runs}", "-seed=1", f"-max_len={LONGEST_INPUT}", f"-artifact_prefix={folder}/", corpus],
                              capture_output=True, text=True, errors="replace", check=False)
        found = [path.read_bytes().hex() for path in pathlib.Path(folder).iterdir()]
    return None if done.returncode == 0 else f"{done.stderr[-3000:]}\ninput: {' '.join(found)}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("target", choices=TARGETS)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=1_000_000)
    given = parser.parse_args()
    name = compiler()
    if name is None:
        return subprocess.run([ROOT / "tools/skip_reason", "no-libfuzzer"], check=False).returncode
    files, defects = TARGETS[given.target]
    system = SYSTEM.get(given.target, [])
    harness = HERE / f"{given.target}_fuzz.cpp"
    folder = given.build / "fuzz" / given.target
    corpus = folder / "corpus"
    shutil.rmtree(folder, ignore_errors=True)
    corpus.mkdir(parents=True)
    seeds.write(HERE / f"{given.target}_corpus.txt", corpus)
    problem = fuzz(built(name, [harness, *(ROOT / file for file in files)], folder / "target", system), corpus, given.runs)
    print(f"{given.runs} runs of {given.target}: {problem or 'nothing found'}")
    missed = 0
    for says, (file, good, bad) in defects.items():
        text = (ROOT / file).read_text()
        if text.count(good) != 1:
            sys.exit(f"{says}: its place is no longer in {file}")
        planted = folder / (re.sub(r"\W", "_", file) + ".cpp")
        planted.write_text(text.replace(good, bad))
        sources = [harness, planted, *(ROOT / other for other in files if other != file)]
        found = fuzz(built(name, sources, folder / "planted", system), corpus, MOST_RUNS_WITH_A_DEFECT)
        print(f"{'found' if found else 'NOT FOUND'}: {says}", flush=True)
        missed += found is None
    return 1 if problem or missed else 0


if __name__ == "__main__":
    sys.exit(main())
