/* The displacement formulation of points that each have a cloud of nodes of their own, for this room only. */
#pragma once
#include "formulation/formulation.h"

/* Groups must be single points: group g is point g. */
void displacement_assemble_cloud(const WeakFormInput *in, WeakFormOutput *out);
LawStatus displacement_commit_cloud(const WeakFormInput *in, Points *points);
