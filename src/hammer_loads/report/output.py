"""Files and directories that the command writes: complete under their name, or not there at all."""
import contextlib
import ctypes
import os
import pathlib
import shutil
import signal
import stat

from report.problem import Problem

GENERATOR = b'<meta name="generator" content="hammer_loads report">'  # of every page's template
AT_FDCWD, RENAME_EXCHANGE = -100, 2  # of Linux
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


def inside(place, folder):
    """Returns True if a path is the folder or lies below it, whatever links lead there."""
    place, folder = os.path.realpath(place), os.path.realpath(folder)
    return place == folder or os.path.commonpath([place, folder]) == folder


def refuse_place(name, needed):
    """A directory that holds what is needed cannot be replaced."""
    for given in [os.getcwd(), *needed]:
        if inside(given, name):
            held = "the working directory" if given == os.getcwd() else given
            raise Problem(f"{name}: holds {held}, must be a directory of its own")


def check_file(name, inputs, force, keep):
    refuse_inputs(name, inputs)
    check_existing(name, force, stat.S_ISREG, "a new file", keep)


def check_directory(name, needed, force, keep):
    """`needed`: paths of inputs and other outputs."""
    refuse_place(name, needed)
    check_existing(name, force, stat.S_ISDIR, "a new directory", keep)


def why_page_must_stay(name):
    """A page of this package may be replaced."""
    try:
        with open(name, "rb") as file:
            return None if GENERATOR in file.read(2000) else "it is no page of this command"
    except OSError as error:
        return error.strerror


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


@contextlib.contextmanager
def signals_wait():
    """Delays signals that end the command until after the block: it does all or nothing."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, signal.SIGTERM, signal.SIGHUP))
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def exchange(one, other):
    """Each path gets what the other had, at one instant."""
    rename = getattr(ctypes.CDLL(None, use_errno=True), "renameat2", None)  # glibc 2.28
    if rename is None or rename(AT_FDCWD, os.fsencode(one), AT_FDCWD, os.fsencode(other), RENAME_EXCHANGE) != 0:
        code = ctypes.get_errno()
        raise OSError(code, os.strerror(code))


def take_place(part, name):
    """The new directory gets the name; at every instant one of the two has it, where the file system can do that."""
    if not os.path.isdir(name):
        os.rename(part, name)
        return
    try:
        exchange(part, name)
    except OSError:
        aside = part + ".old"
        os.rename(name, aside)
        os.rename(part, name)
        os.rename(aside, part)


def publish_directory(name, fill, force):
    """`fill(path)` writes into a new directory, which then gets this name."""
    part = part_name(name)
    try:
        os.mkdir(part)
        fill(pathlib.Path(part))
        if not force and os.path.lexists(name):
            raise Problem(f"{name}: exists meanwhile, must be a new directory")
        with signals_wait():
            take_place(part, name)
    except OSError as error:
        raise Problem(f"{name}: cannot be written: {error.strerror}")
    finally:
        shutil.rmtree(part, ignore_errors=True)
