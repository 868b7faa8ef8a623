# cmake -DPROGRAM=velo -DFOLDER=FOLDER -P manual.cmake: writes the manual pages (man1/*.1) and the completion scripts of
# bash, zsh and fish, which the program makes from the tables of its options.
function(write_output file) # FILE OPTIONS OF velo help...
  execute_process(COMMAND ${PROGRAM} help ${ARGN} OUTPUT_FILE ${FOLDER}/${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER}/man1 ${FOLDER}/bash ${FOLDER}/zsh ${FOLDER}/fish)
write_output(bash/velo --completion bash)
write_output(zsh/_velo --completion zsh)
write_output(fish/velo.fish --completion fish)
write_output(man1/velo.1 --man)
execute_process(COMMAND ${PROGRAM} help --commands OUTPUT_VARIABLE commands OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ";" commands "${commands}")
foreach(command ${commands})
  string(REPLACE " " "-" page "${command}")
  string(REPLACE " " ";" words "${command}")
  write_output(man1/velo-${page}.1 --man ${words})
endforeach()
