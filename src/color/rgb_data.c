/* color/rgb_data.c: the coefficient tables, included by the assembler as read-only data of the
 * object file. */
#include "color/color.h"
#include "color/rgb_table.h"

#define TABLE(space)                                                     \
  __asm__(".section .rodata.vl_table_rgb_" #space                        \
          ",\"a\",@progbits\n.balign 64\n"                               \
          ".globl vl_table_rgb_" #space "\n.hidden vl_table_rgb_" #space \
          "\n"                                                           \
          ".type vl_table_rgb_" #space ", @object\nvl_table_rgb_" #space \
          ":\n"                                                          \
          ".incbin \"" VELO_TABLES "/rgb_" #space                        \
          ".bin\"\n"                                                     \
          ".size vl_table_rgb_" #space ", . - vl_table_rgb_" #space "\n.previous\n")

TABLE(0);
TABLE(1);
TABLE(2);
TABLE(3);

extern const float vl_table_rgb_0[], vl_table_rgb_1[], vl_table_rgb_2[], vl_table_rgb_3[];

const vlRgbTable *vl_rgb_table(vlColorSpace space) {
  static const vlRgbTable tables[4] = {
      {vl_table_rgb_0}, {vl_table_rgb_1}, {vl_table_rgb_2}, {vl_table_rgb_3}};
  return &tables[(unsigned)space < 4 ? space : VL_SPACE_SRGB];
}
