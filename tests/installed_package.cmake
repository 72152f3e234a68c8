# Installs the build in BUILD to a fresh folder, builds the examples of SOURCE against it, and runs them.

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN} failed (${result}):\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

set(work ${BUILD}/installed_package_test)
file(REMOVE_RECURSE ${work})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${work}/prefix)
run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE}/examples -B ${work}/examples -D CMAKE_PREFIX_PATH=${work}/prefix
    -D CMAKE_BUILD_TYPE=Release -Wno-dev)
run(${CMAKE_COMMAND} --build ${work}/examples)

run(${work}/examples/01_estimate)
if(NOT output MATCHES "E = 20000 Pa, nu = 0\\.4")
  message(FATAL_ERROR "01_estimate printed ${output}")
endif()
run(${work}/examples/02_estimate_file ${SOURCE}/examples/scenes/organ.vtu)
if(NOT output MATCHES "\"status\": \"ok\"")
  message(FATAL_ERROR "02_estimate_file printed ${output}")
endif()
run(${work}/prefix/bin/elastimate --version)

# The code of the README is a part of the first example.
file(READ ${SOURCE}/README.md readme)
file(READ ${SOURCE}/examples/01_estimate.cc example)
if(NOT readme MATCHES "```cpp\n([^`]*)```")
  message(FATAL_ERROR "README.md has no code")
endif()
string(REGEX REPLACE "[ \n]+" " " code "${CMAKE_MATCH_1}")
string(REGEX REPLACE "[ \n]+" " " example "${example}")
string(FIND "${example}" "${code}" position)
if(position EQUAL -1)
  message(FATAL_ERROR "the code of README.md is not in examples/01_estimate.cc")
endif()
