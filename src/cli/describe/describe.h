/* Commands and options in the languages of man and of shells: texts to a stream. Not collective. */
#pragma once
#include <stdio.h>
#include "cli/cli.h"

#define CLI_WHAT_IT_IS "implicit large-deformation solver for granular matter and solids"

void describe_man(FILE *out);
void describe_bash(FILE *out);
void describe_zsh(FILE *out);
void describe_fish(FILE *out);
