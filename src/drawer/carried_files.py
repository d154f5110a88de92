"""C++ that carries files inside a program: pictures of bark and leaves, and texts. For SCons and for CMake.

    carried_files.py texts OUT.cpp HEADER ENTRY FUNCTION FILE...
    carried_files.py pictures OUT.cpp PLATFORM DRAWER FOLDER
"""
import os
import shutil
import struct
import subprocess
import sys
import zlib

PRESETS = (
    "generic", "maple", "cherry", "oak", "birch", "willow", "apple", "pine", "spruce", "palm", "ginkgo", "poplar", "magnolia",
)
NAMES = (
    "bark_albedo", "bark_normal", "bark_roughness", "bark_roughness_grey", "bark_young_albedo", "bark_young_normal",
    "bark_young_roughness", "bark_young_roughness_grey", "leaf_albedo", "leaf_normal", "blade_albedo", "blade_normal",
    "sprays_albedo", "sprays_normal",
)


def ending(name):
    """As picture_ending() of exchange/material_textures.h has it."""
    return ".jpg" if name.startswith("bark") and not name.endswith("_grey") else ".png"


def picture_names():
    return ["%s_%s%s" % (preset, name, ending(name)) for preset in PRESETS for name in NAMES]


def packed_png(png):
    """Its pixels packed anew, a third smaller: the drawer's compressor is a simple one."""
    header, pixels = b"", b""
    at = 8
    while at < len(png):
        (size,) = struct.unpack(">I", png[at : at + 4])
        if png[at + 4 : at + 8] == b"IHDR":
            header = png[at + 8 : at + 8 + size]
        elif png[at + 4 : at + 8] == b"IDAT":
            pixels += png[at + 8 : at + 8 + size]
        at += 12 + size
    packer = zlib.compressobj(9, zlib.DEFLATED, 15, 9, zlib.Z_FILTERED)
    pixels = packer.compress(zlib.decompress(pixels)) + packer.flush()
    packed = png[:8]
    for chunk in (b"IHDR" + header, b"IDAT" + pixels, b"IEND"):
        packed += struct.pack(">I", len(chunk) - 4) + chunk + struct.pack(">I", zlib.crc32(chunk))
    return packed


def picture_source(paths, platform):
    """C++ that has the assembler put each distinct picture in once."""
    section = {"windows": '.section .rdata,\\"dr\\"', "macos": ".section __TEXT,__const"}.get(
        platform, '.section .rodata,\\"a\\"'
    )
    # A label that no other file sees has no entry of its own in ARM's table of addresses.
    seen = "" if platform in ("windows", "macos") else ".globl {0}\\n.hidden {0}\\n"
    labels = {}
    data, rows = [], []
    for path in paths:
        if "_sprays_" in os.path.basename(path):
            continue  # the addon's shader alone chooses among several
        with open(path, "rb") as file:
            contents = file.read()
        if contents not in labels:
            labels[contents] = "treerec_picture_%d" % len(labels)
            label = labels[contents]
            own = seen.format(label) + label
            data.append('asm("%s\\n%s:\\n.incbin \\"%s\\"\\n.text");' % (section, own, path.replace("\\", "/")))
            data.append('extern const char %s[] asm("%s");' % (labels[contents], labels[contents]))
        preset, name = os.path.splitext(os.path.basename(path))[0].split("_", 1)
        rows.append('        {"%s", "%s", {%s, %d}},' % (preset, name, labels[contents], len(contents)))
    lines = ['#include "exchange/ready_pictures.h"', '#include "exchange/material_textures.h"', "", *data, ""]
    lines += ["void treerec::use_ready_pictures() {", "    static const ReadyPicture kPictures[] = {", *rows, "    };"]
    return "\n".join(lines + ["    set_ready_pictures(kPictures);", "}", ""])


def text_source(texts, header, entry, function):
    """C++ in which `function` of `header` lists texts as `entry`. texts: (name, text), whose first line is their title after a #."""
    lines = ['#include "%s"' % header, "", "namespace treerec {", "", "static const %s kCarried[] = {" % entry]
    for name, text in texts:
        lines.append('    {"%s", "%s", R"text(%s)text"},' % (name, text.splitlines()[0].lstrip("# "), text))
    lines += ["};", "", "std::span<const %s> %s() { return kCarried; }" % (entry, function), "", "}  // namespace treerec", ""]
    return "\n".join(lines)


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def write_texts(out, header, entry, function, *files):
    texts = []
    for path in files:
        with open(path, encoding="utf-8") as file:
            texts.append((os.path.splitext(os.path.basename(path))[0], file.read()))
    write(out, text_source(texts, header, entry, function))


def write_pictures(out, platform, drawer, folder):
    drawn = os.path.join(folder, "drawn")
    os.makedirs(drawn, exist_ok=True)
    subprocess.run([drawer, drawn, *PRESETS], check=True)
    for name in picture_names():
        if name.endswith(".png"):
            with open(os.path.join(drawn, name), "rb") as file:
                packed = packed_png(file.read())
            with open(os.path.join(folder, name), "wb") as file:
                file.write(packed)
        else:
            shutil.copyfile(os.path.join(drawn, name), os.path.join(folder, name))
    write(out, picture_source([os.path.join(folder, name) for name in picture_names()], platform))


if __name__ == "__main__":
    {"texts": write_texts, "pictures": write_pictures}[sys.argv[1]](*sys.argv[2:])
