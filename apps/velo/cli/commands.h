/* cli/commands.h: the commands of the program, one table each; main.c lists them. */
#ifndef APP_CLI_COMMANDS_H
#define APP_CLI_COMMANDS_H

#include "cli/options.h"

extern const Command render_command, image_info_command, image_diff_command,
    image_convert_command, image_check_command;
extern const Command camera_project_command, camera_unproject_command, camera_info_command,
    camera_convert_command;
extern const Command image_denoise_command, scene_info_command, scene_check_command,
    scene_convert_command, scene_kinds_command, scene_upgrade_command, scene_verify_command;
extern const Command camera_verify_command, camera_vanishing_command, camera_paths_command,
    camera_draw_command;
extern const Command view_command, trace_command;
extern const Command light_info_command;
extern const Command film_info_command, film_merge_command, film_develop_command;
extern const Command sensor_expose_command, sensor_verify_command;
extern const Command raw_develop_command, raw_info_command;

#endif
