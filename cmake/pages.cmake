# The manual pages of PROGRAM into the folder INTO: launchdyn.1, and one for each command that has
# options; where a program MPI is named, that of launchdyn-mpi alone.
file(MAKE_DIRECTORY ${INTO})
if(MPI)
  execute_process(COMMAND ${MPI} help --man OUTPUT_FILE ${INTO}/launchdyn-mpi.1 COMMAND_ERROR_IS_FATAL ANY)
  return()
endif()
execute_process(COMMAND ${PROGRAM} help --man OUTPUT_FILE ${INTO}/launchdyn.1 COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${PROGRAM} complete "" OUTPUT_VARIABLE commands COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[a-z]+\t" commands "${commands}")
foreach(command ${commands})
  string(STRIP ${command} command)
  if(NOT command MATCHES "^(version|help)$")
    execute_process(COMMAND ${PROGRAM} help --man ${command} OUTPUT_FILE ${INTO}/launchdyn-${command}.1
                    COMMAND_ERROR_IS_FATAL ANY)
  endif()
endforeach()
