# Writes the commit of the source into a header, if it is another than what stands there: at each build, so
# that programs never name a commit they were not built from. A + behind it: with changes. What is no
# checkout, as an unpacked archive, has "unknown", or what PENT_COMMIT says in the environment. Call with
# -DSOURCE=<source> -DHEADER=<file>.
cmake_minimum_required(VERSION 3.25)
set(commit unknown)
if(EXISTS ${SOURCE}/.git)
  execute_process(COMMAND git -C ${SOURCE} describe --always --exclude=* --abbrev=12 --dirty=+
    OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE code)
  if(code EQUAL 0)
    set(commit ${described})
  endif()
elseif(NOT "$ENV{PENT_COMMIT}" STREQUAL "")
  set(commit $ENV{PENT_COMMIT})
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define PENT_COMMIT \"@commit@\"\n" @ONLY)
