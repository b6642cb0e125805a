#!/usr/bin/python3
"""Writes small programs that try the corners of RS274/NGC, for compare.py.

Usage: small_programs.py FOLDER

Every cycle in every plane, offsets under rotation, numbers and expressions at the edge of their domain,
cutter compensation in and out of trouble, O words, and files as editors leave them. Many of them are
wrong on purpose: then both readers must refuse them. T1 and T2 of tools.tbl are meant:

    T1 P1 Z10 D4
    T2 P2 X1 Z20 D3
"""

import os
import sys

PROGRAMS = {}


def add(name, text):
    PROGRAMS[name] = text

# Every cycle in every plane, absolute and incremental, with either way of returning.
for c in [73,74,81,82,83,84,85,86,89]:
    for pl,(d,a,b) in {17:('Z','X','Y'),18:('Y','Z','X'),19:('X','Y','Z')}.items():
        for g in (90,91):
            for r in (98,99):
                w=f"R2 {d}-3" if g==90 else f"R-1 {d}-5"
                w+= " Q1.5" if c in(73,83) else ""
                w+= " P0.5" if c in(74,82,84,86,89) else ""
                spin="S100 M4\n" if c==74 else "S100 M3\n"
                add(f"cyc{c}_{pl}_{g}_{r}",
                    f"G21 G90 G{pl} F100 {spin}G0 {d}5\nG{g} G{r} G{c} {a}1 {b}2 {w} L2\n{a}3\n{b}4 L1\nG80\n"
                    f"G90 G0 {d}5\nM2\n")
add("cyc_low", "G21 F100\nG0 Z-5\nG81 X1 Y1 Z-7 R-4\nX2\nG98 X3 R1\nG80\nM2\n")
add("cyc_sticky", "G21 F100\nG0 Z5\nG81 X1 Z-2 R1\nG82 X2 P1\nM2\n")
add("cyc_sticky2", "G21 F100\nG0 Z5\nG81 X1 Z-2 R1\nG0 X5\nG81 X6\nM2\n")
add("cyc_sticky3", "G21 F100\nG0 Z5\nG83 X1 Z-4 R1 Q1\nG73 X2\nM2\n")
add("cyc_inch", "G21 F100\nG0 Z25.4\nG20\nG81 X1 Z-.5 R.1\nG21\nX50\nG80\nM2\n")
add("cyc_g91r", "G21 F100\nG0 Z10\nG91 G81 X1 Y1 Z-4 R-2 L3\nG90 G80\nM2\n")
add("cyc_L0", "G21 F100\nG0 Z10\nG81 X1 Y1 Z-4 R2 L0\nX5\nG80\nM2\n")
add("cyc_noaxis", "G21 F100\nG0 Z10\nG81 R2\nM2\n")
add("cyc_onlyxy", "G21 F100\nG0 Z10\nG81 X1 Y2 R2\nM2\n")
add("cyc_rot", "G21 F100\nG10 L2 P1 R30\nG0 Z10\nG81 X10 Y1 Z-4 R2\nX20\nG80\nM2\n")
add("cyc_g53", "G21 F100\nG0 Z10\nG53 G81 X10 Y1 Z-4 R2\nM2\n")
add("cyc_g93", "G21 F100\nG0 Z10\nG93 G81 X10 Y1 Z-4 R2 F10\nM2\n")
add("cyc_comp", "G21 F100\nG0 Z10\nG41.1 D2\nG81 X10 Y1 Z-4 R2\nM2\n")
add("cyc_g98chg", "G21 F100\nG0 Z10\nG98 G81 X1 Z-4 R2\nG99 X2\nG98 X3\nG80\nM2\n")
add("cyc_rgtz", "G21 F100\nG0 Z10\nG81 X1 Z-4 R12\nX2\nG80\nG0 X0\nM2\n")
add("cyc_zeroq", "G21 F100\nG0 Z10\nG83 X1 Z-4 R2 Q0\nM2\n")
add("cyc_negq", "G21 F100\nG0 Z10\nG83 X1 Z-4 R2 Q-1\nM2\n")
add("cyc_bigq", "G21 F100\nG0 Z10\nG83 X1 Z-4 R2 Q100\nM2\n")
add("cyc_rz", "G21 F100\nG0 Z10\nG81 X1 Z3 R2\nM2\n")
add("cyc_86nospin", "G21 F100\nG0 Z10\nG86 X1 Z-3 R2 P1\nM2\n")
add("cyc_w", "G21 F100 G43.1 Z5\nG0 Z10\nG81 X1 Z-3 R2\nG49\nG80 G0 Z0\nM2\n")
add("cyc_g80x", "G21 F100\nG0 Z10\nG80 X1\nM2\n")
add("cyc_g80g0", "G21 F100\nG81 Z-1 R1 X1\nG80 G0 X1 Y1\nM2\n")
add("cyc_peckP", "G21 F100\nG0 Z10\nG73 X1 Z-4 R2 Q1.5 P0.5\nG80\nM2\n")
add("cyc_87", "G21 F100 S1 M3\nG0 Z10\nG87 X1 Y1 Z-4 R2 I1 J1 K-3\nM2\n")
add("cyc_88", "G21 F100 S1 M3\nG0 Z10\nG88 X1 Y1 Z-4 R2 P1\nM2\n")

# Coordinate systems, shifts, tools, stored points.
add("off1",
    "G21 F100\nG0 X10 Y10 Z1\nG92 X0 Y0\nG10 L2 P1 X5 Y5 R45\nG1 X1 Y1\nG52 X3\nG1 X0 Y0\n"
    "G92.2\nX1\nG92.3\nX1\nG92.1\nX2\nM2\n")
add("off2", "G21 F100\nG10 L20 P1 X5 Y5 Z5\nG1 X0 Y0 Z0\nG10 L20 P2 X1\nG55 X0\nG10 L2 P0 X7 Y8\nX0 Y0\nM2\n")
add("off3", "G21 F100\nG92 X5 Y5\nG10 L20 P1 X0 Y0\nG1 X1 Y1\nG43.1 Z3\nG1 Z0\nG92 Z1\nG49 G1 Z0\nM2\n")
add("off4", "G20 F10\nG10 L2 P1 X1\nG1 X0\nG21\nG1 X0 F100\n#1=#5221\nG1 Y#1\nM2\n")
add("off5", "G21 F100\nG0 X3 Y4 Z5\nG28.1\nG0 X0\nG28 Z7\nG0 X1 Y1\nG28\nG30\nM2\n")
add("off6",
    "G21 F100\nG10 L2 P1 X10 Y0 R90\nG0 X5 Y1\nG28.1\nG0 X0\nG28 X2\nG91 G28 Z3\n"
    "G90 G53 G0 X1 Y1 Z1\nG0 X0\nM2\n")
add("off7", "G21 F100\nG91 G92 X5\nG1 X1\nG90 X1\nM2\n")
add("off8", "G21 F100\n#5221=10\nG1 X0\n#5211=3\nG1 X0\nG54 X0\nG92.3\nG1 X0\nM2\n")
add("off9", "G21 F100\n#5220=3\nG1 X0\nG10 L2 P3 X4\nG1 X0\nG56\nX0\nM2\n")
add("off10",
    "G21 F100\nG10 L2 P1 X1 Y2\nG10 L2 P2 X3 R30\nG54 G1 X1 Y1\nG55 G1 X1 Y1\nG92 X0 Y0\n"
    "G1 X1\nG54 G1 X1\nM2\n")
add("off11", "G21 F100\nG10 L20 P1 R30 X1 Y1\nG1 X0 Y0\nM2\n")
add("off12", "G21 F100\nG10 L2 P1 R30\nG10 L20 P1 X1 Y1\nG1 X0 Y0\nG10 L20 P1 X0\nG1 X1 Y1\nM2\n")
add("off13", "G21 F100\nG10 L2 P1 R30\nG10 L20 P2 X1 Y1\nG55 G1 X0 Y0\nM2\n")
add("off14",
    "G21 F100\nG43.1 X1 Y2 Z3\nG1 X0 Y0 Z0\nG43.2 Z1\nG1 X1 Z0\nG43.2 H1\nG1 Z0\nG43 H2\n"
    "G1 Z0\nG49\nG1 Z0\nM2\n")
add("off15",
    "G21 F100\nT1 M6\nG43\nG1 Z0\nG10 L1 P1 Z20\nG1 Z0\nG43\nG1 Z0\nG10 L10 P1 Z5\nG43\n"
    "G1 Z0\nG10 L11 P1 Z5\nG43 G1 Z0\nM2\n")
add("off16", "G21 F100\nG52\nM2\n")
add("off17", "G21 F100\nG92\nM2\n")
add("off18", "G21 F100\nG92.2 X5\nM2\n")
add("off19", "G21 F100\nG53 X5\nG53 G1 X6\nG53 G2 X7 R5\nM2\n")
add("off20", "G21 F100\nG91 G53 G0 X5\nM2\n")
add("off21", "G21 F100\nG0 G92 X5\nM2\n")
add("off22", "G21 F100\nG10 L2 P10 X1\nM2\n")
add("off23", "G21 F100\nG10 L2 X1\nM2\n")
add("off24", "G21 F100\nG10 L2 P1.5 X1\nM2\n")
add("off25", "G21 F100 G10 L2 P1 X5 R20\nG1 X1\nG2 X3 Y0 I1\nG3 X0 Y0 R2\nM2\n")
add("off26", "G21 F100 G10 L2 P1 X5 R20\nG18 G2 X3 Z0 I1 K0\nM2\n")
add("off27", "G21 F100 G10 L2 P1 X5 R180\nG18 G1 X1\nG91 X1 Y1\nG90 X0 Y0\nG54 X0\nM2\n")

# Numbers, words, codes.
# One line each, or several with NEXT between them.
LINES = """
X1. ~ X.5 ~ X+.5 ~ X+-1 ~ X1e5 ~ X1.5.2 ~ X- 5 ~ X1 2 3 ~ x1 ~ X#1 ~ X-#1 ~ X+#1 ~ X--#1 ~ X[1] ~ X-[1] ~
X+[1] ~ X[-[1]] ~ X[+1] ~ X[1 2] ~ X[] ~ X[1 ~ X1] ~ X ~ X# ~ X##2 ~ X#[1+1] ~ X#<a> ~ X#<_g> ~ X#<  _g > ~
X##<_g> ~ X#0 ~ X#-1 ~ X#1.2 ~ X#2.00001 ~ X#5602 ~ X#5603 ~ X#5601 ~ X00005 ~ X0x5 ~ X1,5 ~ X1(a)2 ~ X(a)1
~ X1;2 ~ (a)X1 ~ X1 (a ~ X1 ) ~ X1 (a(b)c) ~ X1 ((a) ~ N10 X1 ~ N-1 X1 ~ N1.5 X1 ~ N#1 X1 ~ N99999999 X1 ~
X1 N10 ~ N10 N20 X1 ~ /X9 ~  /X9 ~ X1 /X2 ~ % ~ X1 % ~ %X1 ~ X1 Y1 X2 ~ G0 G1 X1 ~ G0 G0 X1 ~ M3 M4 ~ M3 M5
~ M7 M8 ~ M7 M9 ~ M0 M2 ~ G20 G21 ~ G1.0 X1 ~ G01.0 X1 ~ G 1 X 1 ~ G[0+1] X1 ~ G#9 X1 ~ G1.00000001 X1 ~
G1.1 X1 ~ G91.1 X1 ~ G91 .1 X1 ~ M3.0 ~ M3.5 ~ T1.5 ~ T-1 ~ S-1 ~ F-1 G1 X1 ~ F0 G1 X1 ~ G64 P-1 ~ G64 P0.1
Q-1 ~ G4 P-1 ~ G4 ~ G4 P1 X1 ~ G4 P1 G1 X1 ~ D1 ~ H1 ~ P1 ~ Q1 ~ L1 ~ E1 ~ I1 ~ R1 ~ K1 ~ X1 I1 ~ G1 X1 R1 ~
G1 X1 P1 ~ G2 X1 R1 I1 ~ G2 X1 I1 K1 ~ G2 I1 ~ G2 X1 ~ G2 R1 ~ G2 X0 Y0 I1 ~ G2 X2 I1 P2 ~ G2 X2 I1 P0 ~ G2
X2 I1 P1.5 ~ G2 X2 R1 P2 ~ G3 X2 R-1.5 ~ G2 X2 R0.9 ~ G2 X2 R0.9999 ~ G2 X2 I1.0005 ~ G2 X2.001 I1 ~ G2
X2.01 I1 ~ G2 X200.1 I100 ~ G2 X200.3 I100 ~ G2 X0.01 I0.0052 ~ G90.1 G2 X2 I1 ~ G90.1 G2 X2 I1 J0 ~ G90.1
G2 X2 J0 ~ G90.1 G2 I1 J0 ~ G91.1 G91 G2 X2 I1 ~ G17 G2 Z5 I1 ~ G18 G2 X2 I1 ~ G18 G3 X2 Z1 R3 Y4 ~ G19 G2
Y2 J1 ~ G19 G2 Z2 R1 ~ G18 G2 X2 J1 ~ @5 ~ @5 ^30 ~ ^30 ~ X5 ^30 ~ @5 X1 ~ @5 Y1 ~ @-5 ^30 ~ G91 @5 ^30 ~
G18 @5 ^30 ~ @5 ^30 Z4 ~ G2 @5 ^30 R4 ~ @0 ^30 ~ G5.1 X2 I1 ~ G5.1 X2 ~ G5 X2 I1 J1 P1 Q1 ~ G5 X2 P1 Q1 ~ G5
X2 I1 P1 Q1 ~ G5 X2 I1 J1 P1 ~ G5.2 X1 NEXT G5.3 ~ G5.3 ~ G5.2 X1 Y1 L2 NEXT X3 NEXT G5.3 ~ G5.2 P2 NEXT X1
Y1 NEXT X3 NEXT X4 Y4 P0.5 NEXT G5.3 NEXT G1 X0 ~ G5.2 X1 Y1 L5 NEXT X3 NEXT X4 NEXT X5 Y5 NEXT G5.3 ~ G18
G5.1 X2 I1 ~ G93 X1 ~ G93 F2 X1 ~ G93 F2 X1 NEXT X5 ~ G93 F2 X1 NEXT G94 X5 ~ G93 G0 X5 ~ G95 F1 X1 ~ G96
S100 ~ G97 ~ G7 X5 ~ G8 X5 ~ G33 Z1 K1 ~ G38.2 X5 ~ G76 Z1 ~ G12 X1 ~ G6 X1 ~ G17.1 ~ G28 G0 X1 ~ G28 G91 X1
~ M1 ~ M60 ~ M30 ~ M19 ~ M19 R90 ~ M6 ~ M61 Q3 ~ M61 ~ M62 P1 ~ M62 ~ M66 P1 L0 ~ M67 E0 Q1 ~ M68 E0 Q1 ~
M70 NEXT G91 NEXT M72 NEXT X1 ~ M72 ~ M71 ~ M73 NEXT G91 ~ M98 P1 ~ M99 ~ M110 ~ M48 M49 ~ M50 P1 ~ M51 ~
M52 P1 ~ M53 ~ M64 ~ U1 ~ A1 ~ S100 ~ T9 ~ T1 M6 ~ $0 ~ S100 $0 M3 ~ $1 S100 ~ G64 P ~ G61 G64 ~ G61.1 X1 ~
G40 X1 ~ G98 G99 ~ G54 G55 ~ G43 ~ G43 H9 ~ G43 H1 Z5 ~ G43 H0 ~ G43.1 ~ G43.2 ~ G43.2 H1 Z1 ~ G49 H1 ~ G41
D1 ~ G41.1 ~ G41.1 D1 L0 ~ G41.1 D1 L9 ~ G42 D9 ~ G41 ~ G21.0 X1 ~ G90 G91 X1 ~ G90 G90.1 G2 X2 I1 J0 ~ G94
G93 ~ #1=5 X#1 ~ #1=5 #1=6 X1 NEXT X#1 ~ #1 ~ #1 5 ~ #1= ~ #1=[1 ~ #5420=1 ~ #5221=1 X1 ~ #<a>=1 NEXT X#<a>
~ #<A b>=1 NEXT X#<ab> ~ #<a>=1 NEXT #<A>=2 NEXT X#<a> ~ #=1 ~ #<>=1 ~ #<a=1 ~ #[1]=3 NEXT X#1 ~ ##2=3 NEXT
X#2 ~ #1=2 ##1=5 NEXT X#2
"""
for number, line in enumerate(" ".join(LINES.split("\n")).strip().split(" ~ ")):
    lines = line.replace(" NEXT ", "\n")
    add(f"line{number:03d}", f"G21 G90 F100 G1\n#1=1.5 #2=1 #<_g>=2 #9=1\n{lines}\nG1 X7 Y7\nM2\n")

# Expressions, and parameters that tell the state.
EXPRESSIONS = """
2**3**2 ~ -2**2 ~ [-2]**2 ~ [-2]**0.5 ~ [-8]**[1/3] ~ 0**0 ~ 0**-1 ~ 1/0 ~ 0/0 ~ 5 mod 0 ~ -7 mod 3 ~ 7 mod
-3 ~ 7.5 mod 2 ~ 1 eq 1 ~ 1 eq 1.00001 ~ 1 eq 1.0001 ~ 1 ne 1.00009 ~ 1 gt 1.00005 ~ 1 ge 1.00005 ~ 1 lt
1.00005 ~ 1 le 0.99995 ~ 1 and 0 ~ 1 or 0 ~ 1 xor 1 ~ 0.00001 and 1 ~ 2 and 3 ~ 1 + 2 * 3 - 4 / 2 ~ 1+2 gt 2
~ 1 or 0 and 0 ~ 1 xor 1 or 1 ~ 2 lt 3 eq 1 ~ abs[-3] ~ acos[2] ~ acos[1.0000001] ~ asin[-1] ~ asin[2] ~
atan[1]/[0] ~ atan[0]/[0] ~ atan[0]/[-1] ~ atan[1] ~ atan[1]/2 ~ cos[60] ~ sin[-30] ~ tan[90] ~ tan[45] ~
exp[710] ~ exp[1] ~ ln[0] ~ ln[-1] ~ ln[2.718281828459045] ~ sqrt[-1] ~ sqrt[2] ~ sqrt[0] ~ round[2.5] ~
round[-2.5] ~ round[3.5] ~ fix[2.9] ~ fix[-2.9] ~ fix[-3] ~ fup[2.1] ~ fup[-2.1] ~ fup[3] ~ exists[#<_g>] ~
exists[#<b>] ~ exists[#5] ~ exists[1] ~ abs -3 ~ abs[ - 3 ] ~ ABS[-1]+Abs[-1] ~ -abs[-3] ~ +3 ~ - 3 ~ --3 ~
-[-3] ~ #1 ~ -#1 ~ #1+#2 ~ #[1+1] ~ ##2 ~ 1 2 ~ 1 + ~ * 2 ~ [[[[1]]]] ~ 1e3 ~ 1.5.5 ~ sin[30 ~ sin 30 ~
foo[1] ~ 1 foo 2 ~ 1 = 2 ~ 1 == 2 ~ 1 % 2 ~ 1 ^ 2 ~ 2 ** -1 ~ 2**0.5 ~ 1 - -1 ~ 1--1 ~ 1+-1 ~ 10/3*3 ~ 10
mod 3 * 2 ~ 2*3 mod 4 ~ 6/2**2 ~ 1 gt 0 and 2 gt 1 ~ 1 gt 0 gt -1 ~ [1 gt 0] + 1 ~ 3 - 2 - 1 ~ 2 - 3 + 4 ~
0.1+0.2 eq 0.3 ~ not[1] ~ #5420 ~ #5421 ~ #5422 ~ #5399 ~ #5220 ~ #5221 ~ #<_x> ~ #<_metric> ~
#<_motion_mode> ~ #<_plane> ~ #<_feed> ~ #<_rpm> ~ #<_line> ~ #<_coord_system> ~ #<_current_tool> ~
#<_ccomp> ~ #<_absolute> ~ #<_call_level> ~ #<_vmajor> ~ #<_selected_tool> ~ #<_value> ~ #<_value_returned>
~ #<_abs_x> ~ #<_spindle_on> ~ #<_mist> ~ #<_tool_offset> ~ #5400 ~ #5403 ~ #5410 ~ #5161 ~ #31 ~ #5000 ~
#<_inverse_time> ~ #<_retract_old_z> ~ #<_task> ~ #<_units_per_rev> ~ #<_metric_machine> ~ #<_u> ~ #<_g> ~
#<_remote_call>
"""
for number, value in enumerate(" ".join(EXPRESSIONS.split("\n")).strip().split(" ~ ")):
    for units in (20, 21):
        begin = f"G{units} G90 F100 G1\n#1=1.5 #2=1 #<_g>=2\nY2 X3\n"
        add(f"value{number:03d}_{units}", f"{begin}X[{value}]\nM2\n")

# Cutter compensation.
sq="G1 X10 Y0\nX20\nY10\nX10\nY0\nX0\n"
for g in ("41.1 D2","42.1 D2","41.1 D-2","42.1 D0","41 D1","42 D2"):
    n=g.replace(' ','').replace('.','p')
    add(f"cmp_sq_{n}", f"G21 F100\nG{g}\n{sq}G40\nG1 Y-5\nM2\n")
    add(f"cmp_arc_{n}",
        f"G21 F100\nG{g}\nG1 X10\nG3 X20 Y10 J10\nG2 X25 Y15 I5\nG3 X20 Y20 R5\nG1 X0\n"
        f"G40 G1 Y30\nM2\n")
    add(f"cmp_small_{n}",
        f"G21 F100\nG{g}\nG1 X10\nG3 X10.5 Y0.5 J0.5\nG1 Y5\nG2 X11 Y5.5 I0.5\nG1 X15\n"
        f"G40 G1 Y-9\nM2\n")
    add(f"cmp_rev_{n}", f"G21 F100\nG{g}\nG1 X10\nX20\nX10\nX5\nG40\nG1 Y-9\nM2\n")
    add(f"cmp_z_{n}", f"G21 F100\nG{g}\nG1 X10\nZ-5\nX20\nZ1 Y10\nZ3\nX5\nG40 G0 Z9\nG1 Y-9\nM2\n")
    add(f"cmp_rapid_{n}", f"G21 F100\nG{g}\nG0 X10\nX20\nG1 Y10\nX0 Y20\nG40\nG0 X-9\nM2\n")
    add(f"cmp_acute_{n}", f"G21 F100\nG{g}\nG1 X10\nX30\nX12 Y3\nX30 Y6\nG40\nG1 X50\nM2\n")
    add(f"cmp_18_{n}", f"G21 F100 G18\nG{g}\nG1 X10\nZ10\nG2 X15 Z15 I5\nG1 X20\nZ5\nG40\nG1 X50\nM2\n")
    add(f"cmp_full_{n}", f"G21 F100\nG{g}\nG1 X10\nG3 X10 Y0 I5\nG1 X20\nG40\nG1 X50 Y9\nM2\n")
    add(f"cmp_leadarc_{n}", f"G21 F100\nG{g}\nG3 X10 Y10 I10\nG1 X20\nG40\nG1 X50\nM2\n")
    add(f"cmp_short_{n}", f"G21 F100\nG{g}\nG1 X0.5\nX20\nY5\nG40\nG1 X50\nM2\n")
    add(f"cmp_g40same_{n}", f"G21 F100\nG{g} G1 X5\nX20\nY5\nG40 X50\nM2\n")
    add(f"cmp_m2_{n}", f"G21 F100\nG{g} G1 X5\nX20\nY5\nM2\n")
    add(f"cmp_units_{n}", f"G21 F100\nG{g} G1 X5\nX20\nG20 Y1\nX0\nG40 Y9\nM2\n")
    add(f"cmp_inc_{n}", f"G21 F100\nG{g} G91 G1 X5\nX20\nY10\nX-10\nG40 Y-9\nM2\n")
    add(f"cmp_dwell_{n}", f"G21 F100\nG{g} G1 X5\nX20\nG4 P1\nY10\nM5\nX0\nG40 Y-9\nM2\n")
    add(f"cmp_colin_{n}", f"G21 F100\nG{g} G1 X5\nX20\nX25\nX25.0001\nX30 Y0.0001\nX40\nY9\nG40 X0\nM2\n")
    add(f"cmp_gouge_{n}", f"G21 F100\nG{g} G1 X5\nX20\nY0.5\nX40\nY-0.5\nX50\nG40 X90\nM2\n")
    add(f"cmp_side_{n}", f"G21 F100\nG{g} G1 X5\nX20\nG42.1 D1 Y9\nX0\nM2\n")
    add(f"cmp_rot_{n}",
        f"G21 F100\nG10 L2 P1 R30 X5\nG{g} G1 X5\nX20\nY10\nG3 X10 Y20 I-10\nG1 Y0\nG40 X-9\nM2\n")

# O words and subprograms.
add("flow1",
    "G21 F100 G1\no1 while [#1 lt 3]\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\no2 endif\n"
    "X#1\no1 endwhile\nM2\n")
add("flow2",
    "G21 F100 G1\no1 do\n#1=[#1+1]\nX#1\no2 if [#1 ge 4]\no1 break\no2 endif\n"
    "o1 while [#1 lt 9]\nY1\nM2\n")
add("flow3",
    "G21 F100 G1\no1 sub\no2 if [#1 gt 0]\nX#1\no1 return [#1*2]\no2 endif\nY9\no1 endsub\n"
    "o1 call [3]\nX#<_value>\no1 call [0]\nX#<_value> Y#<_value_returned>\nM2\n")
add("flow4",
    "G21 F100 G1\no1 sub\no2 if [#1 gt 0]\nX#1\no1 call [#1-1]\no2 endif\nY#1\no1 endsub\n"
    "o1 call [5]\nM2\n")
add("flow5", "G21 F100 G1\no1 repeat [3]\nG91 X1\no2 repeat [2]\nY1\no2 endrepeat\no1 endrepeat\nM2\n")
add("flow6", "G21 F100 G1\no1 repeat [0]\nX1\no1 endrepeat\nX2\nM2\n")
add("flow7", "G21 F100 G1\no1 repeat [2.6]\nG91 X1\no1 endrepeat\nX2\nM2\n")
add("flow8", "G21 F100 G1\no1 repeat [-2]\nG91 X1\no1 endrepeat\nX2\nM2\n")
add("flow9",
    "G21 F100 G1\no1 if [0]\nX1\no1 elseif [0]\nX2\no1 elseif [1]\nX3\no1 elseif [1]\nX4\n"
    "o1 else\nX5\no1 endif\nM2\n")
add("flow10", "G21 F100 G1\no1 sub\nX#1 Y#2\n#1=9\n#3=8\no1 endsub\n#3=1\n#2=4\no1 call [#3]\nX#1 Y#3\nM2\n")
add("flow11", "G21 F100 G1\no<Name> sub\nX#1\no<name> endsub\no<NAME> call [4]\nM2\n")
add("flow12", "G21 F100 G1\no1 sub\n#<loc>=3\n#<_glob>=5\no1 endsub\no1 call\nX#<_glob>\nX#<loc>\nM2\n")
add("flow13", "G21 F100 G1\no1 endsub\nM2\n")
add("flow14", "G21 F100 G1\no1 if [1]\nX1\nM2\n")
add("flow15", "G21 F100 G1\no1 while [0]\nX1\nM2\n")
add("flow16", "G21 F100 G1\no1 endif\nX1\nM2\n")
add("flow17", "G21 F100 G1\no1 else\nX1\nM2\n")
add("flow18", "G21 F100 G1\no1 break\nX1\nM2\n")
add("flow19", "G21 F100 G1\no1 call\nX1\nM2\no1 sub\nX5\no1 endsub\n")
add("flow20", "G21 F100 G1\no1 sub\nX5\no1 endsub\no[#2+1] call\nM2\n")
add("flow21", "G21 F100 G1\no1 sub\nX5\nM2\no1 endsub\no1 call\nX9\n")
add("flow22", "G21 F100 G1\no1 sub\no1 while [#5 lt 2]\n#5=[#5+1]\nX#5\no1 endwhile\no1 endsub\no1 call\nM2\n")
add("flow23",
    "G21 F100 G1\no1 while [#1 lt 2]\n#1=[#1+1]\no2 while [#2 lt 3]\n#2=[#2+1]\nX#2 Y#1\n"
    "o3 if [#2 eq 2]\no1 continue\no3 endif\no2 endwhile\no1 endwhile\nM2\n")
add("flow24", "G21 F100 G1\no1 if [1] (comment)\nX1\no1 endif ; c\nM2\n")
add("flow25", "G21 F100 G1\nO1\nX1\nO2 (x)\nX2\nM2\n")
add("flow26", "G21 F100 G1\no1 sub\nX1 o2 call\no1 endsub\nM2\n")
add("flow27", "G21 F100 G1\nN10 o1 if [1]\nX1\nN20 o1 endif\nM2\n")
add("flow28", "G21 F100 G1\n/o1 if [1]\nX1\n/o1 endif\nM2\n")
add("flow29", "G21 F100 G1\no1 if 1\nX1\no1 endif\nM2\n")
add("flow30", "G21 F100 G1\no1 if [1] X5\nX1\no1 endif\nM2\n")
add("flow31", "G21 F100 G1\no1if[1]\nX1\no1endif\nM2\n")
add("flow32", "G21 F100 G1\no1 sub\nM73\nG91 X1\no1 endsub\nX5\no1 call\nX6\nM2\n")
add("flow33", "G21 F100 G1\no1 do\nX1\no1 while [0]\nX2\nM2\n")
add("flow34", "G21 F100 G1\no1 sub\no2 sub\nX1\no2 endsub\no1 endsub\no1 call\nM2\n")
add("flow35", "G21 F100 G1\no1 sub\nX1\no1 endsub\no1 sub\nX2\no1 endsub\no1 call\nM2\n")
add("flow36", "G21 F100 G1\no1 if [#1 eq 0]\n#1=1\no1 endif\no1 if [#1 eq 1]\nX7\no1 endif\nM2\n")
add("flow37", "G21 F100 G1\no1 sub\nX#1 Y#30\no1 endsub\no1 call "+" ".join(f"[{i}]" for i in range(1,31))+"\nM2\n")
add("flow38", "G21 F100 G1\no1 sub\nX#1\no1 endsub\no1 call "+" ".join(f"[{i}]" for i in range(1,32))+"\nM2\n")
add("flow39",
    "G21 F100 G1\no1 sub\no2 if [1]\no1 return\no2 endif\nX1\no1 endsub [7]\no1 call\n"
    "X#<_value>\no1 call\nM2\n")
add("m98_1", "O1\nG21 F100 G1\nM98 P2 L2\nM30\nO2\nG91 X1\nM98 P3\nM99\nO3\nY1\nM99\n")
add("m98_2", "G21 F100 G1\nX1\nM98 P2\nX2\nM2\nO2\no5 repeat [2]\nG91 Y1\no5 endrepeat\nG90\nM99\n")
add("m98_3", "G21 F100 G1\nO2\nX1\nM99\nM98 P2\nM2\n")
add("m98_4", "G21 F100 G1\nM98 P2\nM2\nO2\nX1\n")
add("m98_5", "G21 F100 G1\nM99\nM2\n")
add("m98_6", "G21 F100 G1\no1 while [#1 lt 2]\n#1=[#1+1]\nM98 P2\no1 endwhile\nM2\nO2\nX#1\nM99\n")
add("m98_7", "G21 F100 G1\nM98\nM2\nO2\nX#1\nM99\n")
add("m98_8", "G21 F100 G1\nM98 P2 L0\nX9\nM2\nO2\nX1\nM99\n")
add("m98_9", "G21 F100 G1\nM98 P2 L1.5\nX9\nM2\nO2\nX1\nM99\n")
add("m98_10", "G21 F100 G1\nM98 P2\nX9\nM2\nO2\nX1\no1 if [#4 eq 0]\nM99\no1 endif\nX2\nM99\n")

# Files as editors leave them.
add("crlf", "G21 F100\r\nG1 X1\r\nM2\r\n")
add("cr", "G21 F100\rG1 X1\rM2\r")
add("bom", "\ufeffG21 F100\nG1 X1\nM2\n")
add("pct", "%\nG21 F100\nG1 X1\n%\nX2\n")
add("pct2", "\n(c)\n%\nG21 F100\nG1 X1\n%\nX2\n")
add("pct3", "G21 F100\n%\nG1 X1\n%\nX2\n")
add("pct4", "  %  \nG21 F100\nG1 X1\n%\n")
add("pct5", "% name\nG21 F100\nG1 X1\n%\n")
add("pct6", "%(name)\nG21 F100\nG1 X1\n%\n")
add("pct7", "%;name\nG21 F100\nG1 X1\n%\n")
add("long", "G21 F100\n"+" "*300+"G1 X1\nM2\n")
add("long2", "G21 F100\nG1 X1 ("+"a"*300+")\nM2\n")
add("long3", "G21 F100\nG1 X[1"+"+1"*200+"]\nM2\n")
add("tab", "G21\tF100\nG1\tX1\nM2\n")
add("nul", "G21 F100\nG1 X1 \0\nM2\n")
add("utf", "G21 F100\nG1 X1 (\u00b5m)\nM2\n")
add("nomotion", "G21 F100\nX1\nM2\n")
add("units", "G20 F10 G1 X1\nG21 X1\nF100 X2\nG20 X1\nG20 F5 X0\nG21 F5 X0\nM2\n")
add("feedunits", "G21 F100\nG20 F10 G1 X1\nX2\nG21 F100 X1\nX2\nM2\n")
add("g2modal", "G21 F100\nG2 X2 I1\nX4 I1\nI1\nX5 Y1 R1\nM2\n")
add("rotarc", "G21 F100\nG10 L2 P1 R45\nG2 X2 Y2 I2\nG17 G3 X0 Y0 R3\nM2\n")
add("r1",
    "G21 F100\nG10 L2 P1 R30 X3 Y1\nG1 X5 Y6\nG10 L20 P1 X1\nG1 X7 Y7\nG10 L20 P1 Y-2\n"
    "G1 X0 Y0\nG10 L20 P1 X1 Y2 Z3\nG1 X0 Y0 Z0\nM2\n")
add("r2",
    "G21 F100\nG10 L2 P2 R30 X3 Y1\nG1 X5 Y6\nG10 L20 P2 X1\nG55 G1 X7 Y7\n"
    "G54 G10 L20 P0 Y-2\nG1 X0 Y0\nG55 G1 X0 Y0\nM2\n")
add("r3",
    "G21 F100\nG10 L2 P1 R30 X3 Y1\nG1 X5 Y6\nG92 X1 Y1\nG10 L20 P1 X1\nG1 X7 Y7\n"
    "G43.1 X2 Z1\nG10 L20 P1 Y-2 Z4\nG1 X0 Y0 Z0\nM2\n")
add("r4",
    "G21 F100\nG10 L2 P1 R30 X3 Y1 Z2\nG0 X5 Y6\nG28.1\nG0 X0 Y0\nG28 X2\nG28 Y1\nG28 Z9\n"
    "G28 X1 Y1\nG91 G28 X0\nG28 Y1 Z1\nM2\n")
add("r5", "G21 F100\nG0 X1 Y2 Z3\nG28.1 G0 X9\nG30.1\nG92 X0\nG28 X2 Y3\nG30\nG30 Z1\nM2\n")
add("r6", "G21 F100 T1 M6\n#5221=10\nG1 X0\nG55 X0\nG54 X0\n#5230=90\nG54 X1\nG55 X1\nG54 X1 Y1\nM2\n")
add("r7", "G21 F100\n#5211=3\nG1 X0 Y1\nG92.3 G1 X0\nG92.2 G1 X1\nG92 X5\nG1 X5 Y#5211 Z#5210\nM2\n")
add("r8", "G21 F100\n#5220=3\nG10 L2 P0 X4\nG1 X0 Y#5220\nG56 X0 Y1\nG1 X1 Y#5220\nM2\n")
add("r9",
    "G21 F100\nT1 M6 G43\nG1 Z0\nG10 L11 P1 Z5\nG43\nG1 Z0\nG10 L2 P9 Z7\nG92 Z1\n"
    "G10 L11 P1 Z5\nG43\nG1 Z0\nG10 L0\nG1 Z1\nM2\n")
add("r10", "G21 F100\nT1 M6 G43\nG10 L2 P1 R45 X1\nG1 X1 Y1 Z1\nG10 L10 P1 X5 Z5\nG43 G1 X0 Y0 Z0\nM2\n")
add("r11", "G21 F100 G1\nG43 H1\nZ0\nG43.2 H2\nZ0 X0\nG43.2 X3\nX0\nG43.2\nM2\n")
add("r12", "G21 F100 G1\nM19 R90 Q1\nM50 P1\nM51 P0\nM52 P1 X1\nM53 P1\nX2\nM2\n")
add("r13", "G21 F100 G1\no1 call [3]\no2 call\nM2\no1 sub\nX#1\no2 call\no1 endsub\no2 sub\nY1\no2 endsub\n")
add("r14", "G21 F100 G1\no1 sub\nX1\no1 endsub\no5 if [1]\no1 sub\nX2\no1 endsub\no5 endif\nM2\n")
add("r15", "G21 F100 G1\nX#<_line>\n\nX#<_line>\no1 repeat [2]\nY#<_line>\no1 endrepeat\nX[#<_line>]\nM2\n")
add("r16",
    "G21 F100 G1\nX1 Y2 Z3\nG92 X0\nG43.1 Z4\nX#<_abs_x> Y#<_abs_y> Z#<_abs_z>\n"
    "X#<_tool_offset> Y#<_metric_machine>\nX#5420 Y#5421 Z#5422\nM2\n")
add("r17", "G21 F100 G1\nX1 Y2\nG10 L2 P1 R90 X4\nX#<_x> Y#<_y>\nG52 X5\nX#<_x> Y#5421\nM2\n")
add("r18", "G20 F10 G1 X1\nG28.1\n#5161=2\nG28\nG21 G28\nX#5161\nM2\n")
add("r19", "G21 F100\nG91 G28 Z0\nG28 X0 Y0\nG90\nG0 X5 Y5\nG91 G30 Z5\nM2\n")
add("r20", "G21 F100\nG0 X3 Y4\nG91 @2 ^15\n@1\n^10\nG90 @3\n^90\n@3 ^45 Z1\nM2\n")
add("r21", "G21 F100\nG10 L2 P1 X3 R20\nG0 X3 Y4\n@2 ^15\nG1 @4\nG92 X0\n^90\nM2\n")
add("r22", "G21 F100\nG1 X1\nG5 X5 Y5 I1 J2 P1 Q1\nX8 Y2 P0 Q2\nG1 X0\nG5 X1 Y1 P1 Q1\nM2\n")
add("r23", "G21 F100\nG41.1 D2\nG1 X10\nY10\nG92 X1\nM2\n")
add("r24", "G21 F100\nG1 X1 F50 F60\nM2\n")
add("r25",
    "G21 F100\nG1 X1\nG2 X5 Y5 R1000000\nG3 X0 Y0 R-500\nG2 X0 Y0 I0.00001\n"
    "G2 X1 Y0 I0.5 J0 P3 Z4\nM2\n")
add("r26", "G21 F100\nG91\nG1 X0.1\nX0.1\nX0.1\nG90 X0.3\nG91 G2 X1 Y1 I1\nG90.1 G2 X1 Y1 I2 J2\nM2\n")
add("r27",
    "G21 F100\nG18 G91.1 G2 X2 Z2 I2 K0\nG19 G3 Y2 Z0 J2 K0\nG18 G3 X0 Z0 R9 Y5\n"
    "G19 G2 Y0 Z2 R-9 X1\nM2\n")
add("r28", "G21 F100\nG10 L2 P1 R45\nG18 G1 X1\nG2 X2 Z2 R9\nM2\n")
add("r29", "G21 F100\nG53 G1 X1 Y1\nG92 X0\nG53 X5\nX5\nG10 L2 P1 R45 X1 Y1\nG53 X5\nX0 G53\nM2\n")
add("r30", "G21 F100\nG93 G1 X1 F2\nX2 F4\nG0 X9\nG1 X1 Y1 F1\nG2 X3 Y1 I1 F2\nG94 F50\nX9\nM2\n")

# Arcs of rounded coordinates, holes by distance and angle, feedrates of before, numbers with exponents.
for name, text in {
    "within": "G2 X2.028 I1", "beyond": "G2 X2.029 I1", "inch": "G20 G2 X2.0028 I1", "inch_beyond": "G20 G2 X2.0029 I1",
    "share": "G2 X200.1 I100", "share_beyond": "G2 X200.11 I100", "most": "G2 X6002.8 I3000",
    "most_beyond": "G2 X6002.9 I3000", "turn": "G3 X0.02 I10",
}.items():
    add(f"round_{name}", f"G21 F100\n{text}\nM2\n")
add("round_two", "G21 G90 F600\nG0 X0 Y0\nG2 X2.12 Y0.88 I2.12 J-2.13\nG3 X4.25 Y1.76 I2.13 J-2.12\nM2\n")
add("cyc_polar", "G21 F100\nG0 Z10\nG99 G81 @10 ^0 Z-2 R1\n^90\n@5\nG98 @7 ^-30 L2\nG80\nM2\n")
add("cyc_polar91", "G21 F100\nG0 X10 Z10\nG91 G81 ^30 Z-2 R-1 L3\nG80\nG90 G0 X0\nM2\n")
add("cyc_polarx", "G21 F100\nG0 Z10\nG81 @10 ^0 X1 Z-2 R1\nM2\n")
add("f_before", "G21 F600\nG1 X10\nG93 G1 X20 F60\nG94 G1 X30\nM2\n")
add("f_written", "G21 F600\nG1 X10\nG93 G1 X20 F60\nG94 F200 G1 X30\nM2\n")
add("exponent", "G21 F600\nG1 X2.35e-12\nM2\n")
add("exponent_f", "G21 F6e2\nG1 X2\nM2\n")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    for name, text in PROGRAMS.items():
        with open(os.path.join(sys.argv[1], name + ".ngc"), "w", encoding="utf8", newline="") as file:
            file.write(text)


main()
