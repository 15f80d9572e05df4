"""How the examples of each language are made and run."""

import argparse
import pathlib
import subprocess
import sys

JAVA_NAMES = {"follow_pose": "FollowPose", "list_deformed": "ListDeformed", "overlay": "Overlay"}


def arguments():
    parser = argparse.ArgumentParser()
    for name in ("language", "pliant", "examples", "types", "lcm-gen", "built", "round-trip", "javac", "java", "jar"):
        parser.add_argument("--" + name)
    options = parser.parse_args()
    del sys.argv[1:]
    return options


def generate(options, language, folder):
    types = sorted(str(path) for path in pathlib.Path(options.types).glob("*.lcm"))
    flag = {"java": "--jpath", "python": "--ppath"}[language]
    subprocess.run([options.lcm_gen, "--" + language, flag, str(folder), *types], check=True)


def compile_java(options, folder, sources):
    """Compiles the generated classes and `sources`; the class path."""
    generate(options, "java", folder)
    files = [str(path) for path in pathlib.Path(folder).rglob("*.java")] + [str(path) for path in sources]
    subprocess.run([options.javac, "-nowarn", "-cp", options.jar, "-d", str(folder), *files], check=True)
    return f"{options.jar}:{folder}"


def command(options, example, class_path=None):
    """The words that run an example."""
    if options.language == "cpp":
        return [f"{options.built}/pliant_{example}_example"]
    if options.language == "python":
        return [sys.executable, "-B", f"{options.examples}/{example}.py"]
    return [options.java, "-Djava.net.preferIPv4Stack=true", "-cp", class_path, JAVA_NAMES[example]]
