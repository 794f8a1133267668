# cmake -DSOURCE=DIRECTORY -DHEADER=FILE -P revision.cmake
# Writes the revision of the source to a header, at every build; an unchanged header keeps its time, so that nothing is
# compiled again. Known to git: as `git describe` has it, with -dirty for changes not committed. From `git archive`: the
# commit; from scripts/deb: as `git describe` had it. Else, also in the midst of a checkout of something else: unknown.
cmake_minimum_required(VERSION 3.16)
set(revision "")
find_program(git git)
if(git)
  # Not that of a repository that happens to lie around this directory.
  execute_process(COMMAND ${git} ls-files --error-unmatch package.xml WORKING_DIRECTORY ${SOURCE}
                  RESULT_VARIABLE is_foreign OUTPUT_QUIET ERROR_QUIET)
  if(is_foreign EQUAL 0)
    execute_process(COMMAND ${git} describe --always --dirty --abbrev=12 WORKING_DIRECTORY ${SOURCE}
                    OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  endif()
endif()
if(NOT revision)
  file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/archived_revision.txt archived REGEX "^[^$]+$")
  set(revision ${archived})
endif()
if(NOT revision)
  set(revision unknown)
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define HAMMER_LOADS_REVISION \"@revision@\"\n" @ONLY)
