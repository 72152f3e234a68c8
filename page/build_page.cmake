# cmake -D NPM=<npm> -D SOURCE=<this folder> -D WORK=<folder for the packages> -D PAGE=<file to write> -P build_page.cmake
#
# Bundles the page.  Packages are installed once for each package-lock.json.  A failure is a warning, since the page is an
# optional part of the program.
file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json ${SOURCE}/.npmrc ${SOURCE}/build.mjs ${SOURCE}/src DESTINATION ${WORK})

function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    file(REMOVE ${PAGE})
    message(WARNING "The page of reports is left out, since ${ARGN} failed:\n${output}")
  endif()
  set(failed ${result} PARENT_SCOPE)
endfunction()

file(SHA256 ${SOURCE}/package-lock.json lock)
set(installed "")
if(EXISTS ${WORK}/installed)
  file(READ ${WORK}/installed installed)
endif()
set(failed 0)
if(NOT lock STREQUAL installed)
  run(${NPM} ci)
  if(failed EQUAL 0)
    file(WRITE ${WORK}/installed ${lock})
  endif()
endif()
if(failed EQUAL 0)
  run(${NPM} run build -- ${PAGE})
endif()
