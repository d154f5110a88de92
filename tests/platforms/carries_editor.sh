#!/bin/sh
# carries_editor.sh LIBRARY: whether it carries anything of the reconstruction part: its sentences, its classes,
# or what CGAL writes into every program (0: yes, 1: no).
exec grep -qaE 'All points lie on a plane|TreeReconstructor|TreeFidelity|CGAL|LASzip|liblaszip|treerec_picture_' "$1"
