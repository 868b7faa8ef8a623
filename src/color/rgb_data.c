/* color/rgb_data.c: the coefficient tables, included by the assembler as read-only data of the object file. */
#include "color/tables.h"

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
