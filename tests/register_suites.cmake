# cmake -D PROGRAM=<test program> -D FOLDER=<folder> -D COST=<number> -D TIMEOUT=<seconds> -D FILE=<file to write> -P register_suites.cmake
#
# Writes what registers each suite of a test program as one test.  A test of its own for each test would start the
# program, and load its libraries, many times more often, which takes longer than most tests.  A suite that skips a test
# counts as skipped, unless it fails: then it does not end with the list of skipped tests.  A suite may take TIMEOUT
# seconds, six times as long where its name, or that of its instantiation, ends with "Statistics" or "Long", and twenty times where with "Remade".
execute_process(
  COMMAND ${PROGRAM} --gtest_list_tests
  OUTPUT_VARIABLE lines
  TIMEOUT 60 COMMAND_ERROR_IS_FATAL ANY)
# What follows a name may be any text.
string(REGEX REPLACE " *#[^\n]*" "" lines "${lines}")
string(REGEX MATCHALL "[^ \n]+\\.\n" suites "\n${lines}")
if(NOT suites)
  message(FATAL_ERROR "${PROGRAM} lists no suite of tests.")
endif()

set(script "")
foreach(suite ${suites})
  string(REGEX REPLACE "\\.\n" "" suite "${suite}")
  set(label ${FOLDER})
  set(timeout ${TIMEOUT})
  if(suite MATCHES "(Statistics|Long)(/|$)")
    string(APPEND label -long)
    math(EXPR timeout "6 * ${TIMEOUT}")
  elseif(suite MATCHES "Remade$")
    set(label studies)
    math(EXPR timeout "20 * ${TIMEOUT}")
  endif()
  string(
    APPEND
    script
    "add_test([[${FOLDER}.${suite}]] [[${PROGRAM}]] [[--gtest_filter=${suite}.*]])\n"
    "set_tests_properties([[${FOLDER}.${suite}]] PROPERTIES TIMEOUT ${timeout} LABELS ${label} COST ${COST}\n"
    "  SKIP_REGULAR_EXPRESSION [[\\[  SKIPPED \\] [^ \n]+\n$]])\n")
endforeach()
file(WRITE ${FILE} "${script}")
