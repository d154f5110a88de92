#!/usr/bin/env python3
"""Gathers the words that the editor's part of the addon shows, for its translations.

    editor_strings.py            writes tree_reconstruction.pot and brings the .po files up to date: new words come
                                 without a translation, words that are gone go
    editor_strings.py --check    says what is out of date, missing, or translated with other placeholders; 1 if any is
    editor_strings.py --missing LANGUAGE    prints the words without a translation, one JSON string per line

A word is found where it is written out: in tr("…"), in a control's text, title or tooltip, in what is added to a menu
or list, and in calls of what makes the dock's widgets, and in the descriptions of a reconstruction's options. Parts that are joined
by + are one.
"""
import json
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
ADDON = ROOT / "addons/tree_reconstruction"
# Tables of options, and what ends each.
OPTIONS = {
    ROOT / "extension/tree_reconstructor/reconstruct_options.cpp": "#undef OPTION_MEMBER",
    ROOT / "extension/tree_reconstructor/photo_options.cpp": "    };",
}
SENTENCES = ADDON / "editor/translations/sentences.gd"
FOLDER = ADDON / "editor/translations"
POT = FOLDER / "tree_reconstruction.pot"
LANGUAGES = ("zh_CN", "zh_TW", "ja")
# Pieces of a sentence that are shorter say nothing by themselves.
SHORTEST = 4
SHOWN = r"text|title|tooltip_text|placeholder_text|dialog_text|ok_button_text|cancel_button_text"
ADDED = r"add_item|add_check_item|add_radio_check_item|add_icon_item|add_icon_check_item|add_separator|add_submenu_node_item"
BEGIN = re.compile(r"(?<!\w)tr\(|(?<![\w])(?:%s)\s*=\s*(?!=)|\.(?:%s)\(" % (SHOWN, ADDED))
# Their arguments are words, but for names (&"name"), keys, and what has no capital and no blank.
MAKERS = re.compile(r"(?<!func )\b(?:Widgets\s*\.\s*\w+|_add\w*|_on_choice\.bind)\s*\(")
WORDS = re.compile(r"[A-Z][a-z]+(?![a-z]*[A-Z])|\S+ \S+")
STRING = re.compile(r'"""(.*?)"""|"((?:[^"\\\n]|\\.)*)"|\'((?:[^\'\\\n]|\\.)*)\'', re.S)
PLACEHOLDER = re.compile(r"%[-+0-9.*]*[sdfxcv%]|\{\w*\}")
ESCAPES = {"n": "\n", "t": "\t", "r": "\r", '"': '"', "'": "'", "\\": "\\"}


def unescape(text):
    return re.sub(r"\\(.)", lambda m: ESCAPES.get(m[1], m[1]), text, flags=re.S)


def expression(source, at):
    """The text of the literals joined by + from `at`; none where something else stands there."""
    parts, wanted = [], True
    while at < len(source):
        if source[at] in " \t\n(":
            at += 1
        elif source[at] == "+" and not wanted:
            wanted, at = True, at + 1
        elif wanted and source[at] in "\"'":
            match = STRING.match(source, at)
            if not match:
                return None
            parts.append(unescape(next(group for group in match.groups() if group is not None)))
            wanted, at = False, match.end()
        else:
            break
    return None if wanted or not parts else "".join(parts)


def arguments(source, at):
    """The words among the arguments of a call whose parenthesis was opened before `at`."""
    depth, words = 1, []
    while depth > 0 and at < len(source):
        if source[at] in "\"'":
            match = STRING.match(source, at)
            named = source[at - 1] in "&^$"
            word = None if named else expression(source, at)
            # The parts of a joined word are one: go on behind the last.
            if word is not None and WORDS.match(word) and re.search("[A-Za-z]{3}", PLACEHOLDER.sub("", word)):
                words.append(word)
            while match:
                at = match.end()
                joined = re.compile(r"[\s)]*\+[\s(]*").match(source, at)
                depth -= joined[0].count(")") - joined[0].count("(") if joined else 0
                match = STRING.match(source, joined.end()) if joined else None
                at = joined.end() if joined and not match else at
            continue
        depth += (source[at] in "([{") - (source[at] in ")]}")
        at += 1
    return words


def without_comments(source):
    """Comments made blank; a # in a string is none."""
    return re.sub(
        r'"""(?s:.*?)"""|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)*\'|#[^\n]*',
        lambda m: " " * len(m[0]) if m[0][0] == "#" else m[0],
        source,
    )


def find_words():
    """Words in the order in which they are found, and where."""
    words = {}
    for path in sorted([ADDON / "plugin.gd", *(ADDON / "editor").rglob("*.gd")]):
        source = without_comments(path.read_text(encoding="utf-8"))
        found = [(match.start(), expression(source, match.end())) for match in BEGIN.finditer(source)]
        for match in MAKERS.finditer(source):
            found += [(match.start(), word) for word in arguments(source, match.end())]
        for _, word in sorted((place, word) for place, word in found if word is not None):
            if re.search(r"[A-Za-z]{2}", word):
                words.setdefault(word, []).append(path.relative_to(ADDON).as_posix())
    for word in sentences():
        words.setdefault(word, []).append(SENTENCES.relative_to(ADDON).as_posix())
    for path, end in OPTIONS.items():
        for word in option_descriptions(path, end):
            words.setdefault(word, []).append(path.relative_to(ROOT).as_posix())
    return words


def sentences():
    """The entries of PATTERNS: what the library says."""
    for path in (SENTENCES, *(SENTENCES.with_name(name + "_sentences.gd") for name in ("twig", "sketch", "branch", "growth", "skeleton"))):
        source = without_comments(path.read_text(encoding="utf-8"))
        table = source[source.index("const PATTERNS") :]
        table = table[table.index("[") + 1 : table.index("\n]\n")]
        for entry in re.split(r",\n\t(?=[\"'(\]]|\s*[\"'(])", table):
            word = expression(entry, 0)
            if word:
                yield word


def in_editor():
    """What the library says of its program's options, and what the editor says instead."""
    source = without_comments(SENTENCES.read_text(encoding="utf-8"))
    table = source[source.index("const IN_EDITOR") :]
    pairs = re.findall(r'"((?:[^"\\\n]|\\.)*)":\s*"((?:[^"\\\n]|\\.)*)"', table[: table.index("}")])
    return [(unescape(said), unescape(told)) for said, told in pairs]


def of_the_program():
    """Options of the program that sentences of the library name, and IN_EDITOR does not."""
    for path in sorted([*(ROOT / "src").rglob("*.cpp"), *(ROOT / "extension").rglob("*.cpp")]):
        if path.relative_to(ROOT).parts[:2] in (("src", "cli"), ("src", "drawer")):
            continue
        source = re.sub(r'"\s*\n\s*"', "", path.read_text(encoding="utf-8"))
        for literal in re.findall(r'"((?:[^"\\\n]|\\.)*)"', source):
            text = unescape(literal)
            # A word by itself is for another program, not for a user.
            if re.fullmatch(r"--\S+", text):
                continue
            for said, _ in in_editor():
                text = text.replace(said, "")
            for option in re.findall(r"(?<![\w(-])\(?--[a-z][a-z-]+", text):
                yield path.relative_to(ROOT).as_posix(), option


def unsaid():
    """What the library's sources do not say, of the entries of PATTERNS."""
    paths = [path for end in ("*.cpp", "*.lstring") for path in (ROOT / "src").rglob(end)] + [*(ROOT / "extension").rglob("*.cpp")]
    sources = "".join(path.read_text(encoding="utf-8") for path in sorted(paths))
    # Literals that follow each other are one.
    sources = unescape(re.sub(r'"\s*\n\s*"', "", sources))
    for word in sentences():
        said = word
        for program, editor in in_editor():
            said = said.replace(editor, program)
        for piece in said.split("%s"):
            # The sources may put it together of several literals. A name in a library is capitalized when it is shown.
            rest = piece.strip() if piece.strip() in sources else piece.strip().lower() if " " not in piece else piece.strip()
            while len(rest) >= SHORTEST:
                length = max((n for n in range(len(rest) + 1) if rest[:n] in sources), default=0)
                if length < SHORTEST:
                    yield word, rest
                    break
                rest = rest[length:]


def option_descriptions(path, end):
    """The last text of each entry of a table of options, whose pieces follow each other."""
    source = path.read_text(encoding="utf-8")
    begin = re.search(r"const Option \w+\[\]", source).start()
    table = source[begin : source.index(end, begin)]
    pieces = r'"((?:[^"\\\n]|\\.)*)"'
    for match in re.finditer(r'((?:%s\s*)+)\}' % pieces, table):
        yield "".join(unescape(piece) for piece in re.findall(pieces, match[1]))


def quoted(text):
    return '"%s"' % text.replace("\\", "\\\\").replace('"', '\\"').replace("\t", "\\t").replace("\n", "\\n")


def file_text(words, language, translations):
    head = [
        "Project-Id-Version: Tree Reconstruction\\n",
        "MIME-Version: 1.0\\n",
        "Content-Type: text/plain; charset=UTF-8\\n",
        "Content-Transfer-Encoding: 8bit\\n",
    ]
    if language:
        head += ["Language: %s\\n" % language, "Plural-Forms: nplurals=1; plural=0;\\n"]
    lines = ["# Words of the Tree Reconstruction editor. tests/tools/editor_strings.py keeps this file up to date.", 'msgid ""', 'msgstr ""']
    lines += ['"%s"' % line for line in head]
    for word, places in words.items():
        lines += ["", "#: " + " ".join(sorted(set(places))), "msgid " + quoted(word), "msgstr " + quoted(translations.get(word, ""))]
    return "\n".join(lines) + "\n"


def read(path):
    """The translations in a .po file; several quoted lines are one text."""
    pairs, key, texts = {}, None, {}
    if not path.exists():
        return pairs
    for line in path.read_text(encoding="utf-8").splitlines() + [""]:
        match = re.match(r'(msgid|msgstr)?\s*"(.*)"$', line)
        if match:
            key = match[1] or key
            texts[key] = (texts.get(key, "") if not match[1] else "") + unescape(match[2])
        elif texts:
            if texts.get("msgid"):
                pairs[texts["msgid"]] = texts.get("msgstr", "")
            key, texts = None, {}
    return pairs


def problems(words):
    found = ["%s: the library says nothing like %s" % (SENTENCES.name, quoted(piece)) for _, piece in unsaid()]
    found += ["%s: %s is named to users of the editor; IN_EDITOR lacks it" % each for each in of_the_program()]
    if not POT.exists() or POT.read_text(encoding="utf-8") != file_text(words, "", {}):
        found.append("%s is out of date: run tests/tools/editor_strings.py" % POT.name)
    for language in LANGUAGES:
        pairs = read(FOLDER / (language + ".po"))
        if list(pairs) != list(words):
            found.append("%s.po is out of date: run tests/tools/editor_strings.py" % language)
        for word in words:
            translated = pairs.get(word, "")
            if not translated:
                found.append("%s.po: no translation of %s" % (language, quoted(word)))
            elif PLACEHOLDER.findall(word) != PLACEHOLDER.findall(translated):
                found.append("%s.po: other placeholders in the translation of %s" % (language, quoted(word)))
    return found


def main():
    words = find_words()
    if sys.argv[1:] == ["--check"]:
        found = problems(words)
        print("\n".join(found + ["%d words" % len(words)]))
        return 1 if found or not words else 0
    if len(sys.argv) == 3 and sys.argv[1] == "--missing":
        pairs = read(FOLDER / (sys.argv[2] + ".po"))
        print("\n".join(json.dumps(word, ensure_ascii=False) for word in words if not pairs.get(word)))
        return 0
    FOLDER.mkdir(exist_ok=True)
    POT.write_text(file_text(words, "", {}), encoding="utf-8")
    for language in LANGUAGES:
        path = FOLDER / (language + ".po")
        path.write_text(file_text(words, language, read(path)), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
