"""Files and directories that the command writes: complete under their name, or not there at all."""
import os
import pathlib
import shutil
import stat

from report.problem import Problem

KINDS = [(stat.S_ISDIR, "a directory"), (stat.S_ISLNK, "a symbolic link"), (stat.S_ISFIFO, "a FIFO"),
         (stat.S_ISSOCK, "a socket")]


def kind_of(mode):
    return next((name for test, name in KINDS if test(mode)), "a device")


def refuse_inputs(name, inputs):
    for given in inputs:
        if os.path.exists(name) and os.path.exists(given) and os.path.samefile(name, given):
            raise Problem(f"{name}: is the input {given}, must be another file")


def check_existing(name, force, is_expected, expected, keep):
    """Raises unless the name is free, or may be replaced. `keep(name)`: why what is there must stay, or nothing."""
    try:
        mode = os.lstat(name).st_mode
    except FileNotFoundError:
        return
    except OSError as error:
        raise Problem(f"{name}: {error.strerror}")
    if not is_expected(mode):
        raise Problem(f"{name}: is {'a regular file' if stat.S_ISREG(mode) else kind_of(mode)}, must be {expected}")
    if not force:
        raise Problem(f"{name}: exists already, must be {expected}; --force replaces one that this command wrote")
    reason = keep(name)
    if reason:
        raise Problem(f"{name}: --force does not replace it: {reason}")


def check_file(name, inputs, force, keep):
    refuse_inputs(name, inputs)
    check_existing(name, force, stat.S_ISREG, "a new file", keep)


def check_directory(name, force, keep):
    check_existing(name, force, stat.S_ISDIR, "a new directory", keep)


def part_name(name):
    return f"{name.rstrip('/')}.part.{os.getpid()}"


def publish_file(name, data, force):
    """Gives the bytes this name; a file that has appeared meanwhile is not replaced without force."""
    part = part_name(name)
    try:
        with open(part, "xb") as file:
            file.write(data)
        if force:
            os.replace(part, name)
        else:
            os.link(part, name)
    except OSError as error:
        raise Problem(f"{name}: cannot be written: {error.strerror}")
    finally:
        if os.path.lexists(part):
            os.unlink(part)


def publish_directory(name, fill, force):
    """`fill(path)` writes into a new directory, which then gets this name."""
    part = part_name(name)
    try:
        os.mkdir(part)
        fill(pathlib.Path(part))
        if force and os.path.isdir(name):
            shutil.rmtree(name)
        os.rename(part, name)
    except OSError as error:
        raise Problem(f"{name}: cannot be written: {error.strerror}")
    finally:
        shutil.rmtree(part, ignore_errors=True)
