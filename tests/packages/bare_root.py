#!/usr/bin/env python3
"""Makes a root folder that holds Debian's essential packages and what some .deb files depend on, and nothing else.

bare_root.py ROOT DEB...

The files are copies of this machine's, so that no network is needed. dpkg in the new root knows its packages, and so refuses a .deb
whose dependencies are not among them. A dependency that this machine lacks is named, and the exit code is 3.
"""
import os
import re
import subprocess
import sys

INFO = "/var/lib/dpkg/info"
# A program that needs its documentation to run would be found by this.
LEFT_OUT = re.compile(r"/usr/share/(doc|man|info|locale|lintian|bug)/")


def stanzas(text):
    """The packages of a status file: their fields by name, and the text as it is."""
    for text in text.split("\n\n"):
        fields = dict(re.findall(r"^(\S+): *((?:.*)(?:\n .*)*)", text, re.M))
        if fields:
            yield fields, text


def alternatives(depends):
    """Each dependency as the names that fulfil it. Versions are dpkg's matter."""
    for dependency in filter(str.strip, depends.split(",")):
        yield [re.match(r"\s*([^\s(:]+)", name).group(1) for name in dependency.split("|")]


def main(root, debs):
    installed, texts, providers = {}, {}, {}
    for fields, text in stanzas(open("/var/lib/dpkg/status", encoding="utf-8").read()):
        if fields.get("Status") != "install ok installed":
            continue
        name = fields["Package"]
        installed[name], texts[name] = fields, text
        for names in alternatives(fields.get("Provides", "")):
            providers.setdefault(names[0], []).append(name)

    ours = {}
    for deb in debs:
        control = subprocess.run(["dpkg-deb", "-f", deb], check=True, capture_output=True, text=True).stdout
        for fields, _ in stanzas(control):
            ours[fields["Package"]] = fields

    chosen, missing = set(), set()
    waiting = [(name, fields) for name, fields in installed.items() if fields.get("Essential") == "yes"]
    waiting += ours.items()
    seen = set()
    while waiting:
        name, fields = waiting.pop()
        if name in seen:
            continue
        seen.add(name)
        if name not in ours:
            chosen.add(name)
        for names in alternatives(fields.get("Pre-Depends", "") + "," + fields.get("Depends", "")):
            if any(n in ours for n in names):
                continue
            found = [n for n in names if n in installed] or [p for n in names for p in providers.get(n, [])]
            if found:
                waiting.append((found[0], installed[found[0]]))
            else:
                missing.add(" | ".join(names))
    if missing:
        print("this machine lacks " + ", ".join(sorted(missing)), file=sys.stderr)
        return 3

    copied, info = set(), os.path.join(root, "var/lib/dpkg/info")
    for folder in (info, *(os.path.join(root, d) for d in ("var/lib/dpkg/updates", "var/lib/dpkg/triggers", "tmp"))):
        os.makedirs(folder)
    mine = re.compile(r"^(.*?)(:[^:.]+)?\.[^.]+$")
    for name in os.listdir(INFO):
        match = mine.match(name)
        if not match or match.group(1) not in chosen:
            continue
        subprocess.run(["cp", "-p", os.path.join(INFO, name), info], check=True)
        if name.endswith(".list"):
            copied.update(line for line in open(os.path.join(INFO, name), encoding="utf-8").read().splitlines()
                          if line != "/." and not LEFT_OUT.match(line))
    # What packages' scripts make: the links of update-alternatives, and accounts.
    for folder, _, names in os.walk("/etc/alternatives"):
        for name in names:
            if not os.path.exists("/var/lib/dpkg/alternatives/" + name):
                continue
            link, target = os.path.join(folder, name), os.path.realpath(os.path.join(folder, name))
            if target in copied or target.replace("/usr/lib/", "/lib/", 1) in copied:
                copied.add(link)
                for line in open("/var/lib/dpkg/alternatives/" + name, encoding="utf-8").read().splitlines()[1:2]:
                    copied.add(line)
    copied.update(("/etc/passwd", "/etc/group", "/bin", "/sbin", "/lib", "/lib64"))
    # A package may say /bin/ls where /bin is a link to /usr/bin.
    real = {os.path.join(os.path.realpath(os.path.dirname(p)), os.path.basename(p)) for p in copied if os.path.lexists(p)}
    names = "\0".join(sorted(p.lstrip("/") for p in real))
    make = subprocess.Popen(["tar", "-C", "/", "-c", "--no-recursion", "--null", "--verbatim-files-from", "-T", "-"],
                            stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    take = subprocess.Popen(["tar", "-x", "-C", root], stdin=make.stdout)
    make.stdin.write(names.encode())
    make.stdin.close()
    if make.wait() != 0 or take.wait() != 0:
        return 1

    with open(os.path.join(root, "var/lib/dpkg/status"), "w", encoding="utf-8") as status:
        for name in sorted(chosen):
            status.write(texts[name].strip("\n") + "\n\n")
    with open(os.path.join(root, "var/lib/dpkg/triggers/File"), "w", encoding="utf-8") as triggers:
        for line in open("/var/lib/dpkg/triggers/File", encoding="utf-8"):
            if line.split()[1].split("/")[0].split(":")[0] in chosen:
                triggers.write(line)
    for folder in ("proc", "dev", "root"):
        os.makedirs(os.path.join(root, folder), exist_ok=True)
    # What the scripts of those packages do when they are installed, as far as ours have them do it again.
    again = "ldconfig && if command -v update-mime-database >/dev/null; then update-mime-database /usr/share/mime; fi"
    return subprocess.run(["chroot", root, "/bin/sh", "-c", again], check=False).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
