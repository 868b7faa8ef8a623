# cmake -DSOURCE=FOLDER -DRESULT=FILE.c -P commit.cmake: writes the commit of the source (empty where git or its
# repository is missing) as the constant velo_commit; leaves the file alone where nothing has changed.
execute_process(COMMAND git -C ${SOURCE} rev-parse --show-cdup OUTPUT_VARIABLE up OUTPUT_STRIP_TRAILING_WHITESPACE
                RESULT_VARIABLE status ERROR_QUIET)
set(commit "")
if(status EQUAL 0 AND up STREQUAL "") # the repository is the source's own, not one around it
  execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 OUTPUT_VARIABLE commit
                  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
file(CONFIGURE OUTPUT ${RESULT} CONTENT "extern const char velo_commit[];\nconst char velo_commit[] = \"${commit}\";\n" @ONLY)
