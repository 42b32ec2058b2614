# Writes the C source INTO, which names the commit of the sources in FROM, "unknown" where they are
# no checkout of their own. A file that would stay the same is left alone, so nothing is linked again.
set(commit unknown)
find_program(GIT git)
if(GIT)
  execute_process(COMMAND ${GIT} -C ${FROM} rev-parse --show-toplevel
                  OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed ERROR_QUIET)
  get_filename_component(from ${FROM} REALPATH)
  if(NOT failed AND top STREQUAL from)
    execute_process(COMMAND ${CMAKE_COMMAND} -E env GIT_OPTIONAL_LOCKS=0
                            ${GIT} -C ${FROM} describe --tags --always --dirty --abbrev=12
                    OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed
                    ERROR_QUIET)
    if(NOT failed AND described MATCHES "^[A-Za-z0-9._/+-]+$")
      set(commit ${described})
    endif()
  endif()
endif()
set(text "#include \"results/program.h\"\n\nconst char program_commit[] = \"${commit}\";\n")
set(before "")
if(EXISTS ${INTO})
  file(READ ${INTO} before)
endif()
if(NOT text STREQUAL before)
  file(WRITE ${INTO} "${text}")
endif()
