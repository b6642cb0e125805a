//! Lines made of the words of the language.

#![no_main]

use arbitrary::Arbitrary;
use libfuzzer_sys::fuzz_target;
use std::fmt::Write;

const CODES: [&str; 130] = [
    "G0",
    "G1",
    "G2",
    "G3",
    "G4",
    "G5",
    "G5.1",
    "G5.2",
    "G5.3",
    "G10 L2",
    "G10 L20",
    "G10 L1",
    "G10 L10",
    "G17",
    "G18",
    "G19",
    "G20",
    "G21",
    "G28",
    "G28.1",
    "G30",
    "G30.1",
    "G40",
    "G41",
    "G42",
    "G41.1",
    "G42.1",
    "G43",
    "G43.1",
    "G43.2",
    "G49",
    "G53",
    "G54",
    "G55",
    "G59.3",
    "G61",
    "G64",
    "G73",
    "G74",
    "G80",
    "G81",
    "G82",
    "G83",
    "G84",
    "G85",
    "G86",
    "G87",
    "G88",
    "G89",
    "G90",
    "G91",
    "G90.1",
    "G91.1",
    "G92",
    "G92.1",
    "G92.2",
    "G92.3",
    "G93",
    "G94",
    "G97",
    "G98",
    "G99",
    "M0",
    "M2",
    "M3",
    "M6",
    "M66",
    "M68",
    "M70",
    "M71",
    "M72",
    "M73",
    "M104",
    "G43.4",
    "G52",
    "G6.2 P2 K0",
    "G6.2 P3 K0 X0",
    "K0",
    "K1",
    "G10 L11",
    "M98",
    "M98 P1",
    "M98 P2 L2",
    "M99",
    "G9",
    "G10 L2 P0",
    "G10 L10 P1 R",
    "G10 L12 P1 R",
    "G10 L20 P3",
    "G12 I3.",
    "G13 I1. K3. Q",
    "G15",
    "G16",
    "G27",
    "G29",
    "G30 P2",
    "G41 D1",
    "G43 H1",
    "G44 H2",
    "G50",
    "G50.1",
    "G51 P2.",
    "G51 P500",
    "G51 I-1. J1. K1.",
    "G51.1",
    "G54.1 P",
    "G54 P1",
    "G154 P2",
    "G110",
    "G65 P1",
    "G65 P2 A1. I2. I3.",
    "G66 P1",
    "G67",
    "G68 X1. R",
    "G68 R90.",
    "G69",
    "G76",
    "G87",
    "G101",
    "G100",
    "G103 P1",
    "G187 P1",
    "G5 P10000",
    "G5.1 Q1",
    "G8 P1",
    "M97 P10",
    "M98 P21",
    "M98 P20001",
    "M99 P10",
    ",R1. ",
];
const LETTERS: [&str; 26] = [
    "X", "Y", "Z", "I", "J", "K", "R", "P", "Q", "F", "L", "D", "H", "S", "T", "@", "^", "A", "B",
    "C", "E", "N", "U", "V", "W", "$",
];
const FUNCTIONS: [&str; 14] = [
    "ABS", "ACOS", "ASIN", "ATAN", "COS", "EXP", "FIX", "FUP", "LN", "ROUND", "SIN", "SQRT", "TAN",
    "EXISTS",
];
const OPERATORS: [&str; 15] = [
    "+", "-", "*", "/", "**", " MOD ", " AND ", " OR ", " XOR ", " EQ ", " NE ", " GT ", " GE ",
    " LT ", " LE ",
];
const KEYWORDS: [&str; 15] = [
    "sub",
    "endsub",
    "call",
    "return",
    "if",
    "elseif",
    "else",
    "endif",
    "while",
    "endwhile",
    "do",
    "repeat",
    "endrepeat",
    "break",
    "continue",
];
const STATEMENTS: [&str; 12] = [
    "GOTO/",
    "FROM/",
    "GODLTA/",
    "CIRCLE/",
    "FEDRAT/",
    "RAPID",
    "UNITS/MM",
    "UNITS/INCHES",
    "LOADTL/",
    "DELAY/",
    "END",
    "GOTO/1,2,3,0,0,1,",
];

const ORDERS: [&str; 46] = [
    "IF [#1 EQ #0] GOTO ",
    "IF [#1 LT 3] THEN #1=",
    "WHILE [#1 LT 3] DO1 ",
    "WHILE [#2 NE 0] DO2 ",
    "DO1 ",
    "DO3 ",
    "END1 ",
    "END2 ",
    "GOTO 1",
    "N10 #1=#1+",
    "#1=#[",
    "#500=#500+",
    "#5221=",
    "#3000=",
    "IF [[#1 GT 0] AND #2] M98 P",
    ":1 N1 ",
    "IF R1<",
    "IF (R1==1) AND R2>",
    "IF R1>2 GOTOF ",
    "IF R1<3 GOTOB ",
    "ELSE",
    "ENDIF",
    "WHILE R1<",
    "ENDWHILE",
    "FOR I=1 TO ",
    "FOR R1=R2 TO ",
    "ENDFOR",
    "LOOP",
    "ENDLOOP",
    "REPEAT",
    "UNTIL R1>",
    "GOTOF ",
    "GOTOB ",
    "GOTO ",
    "GOTOC ",
    "MARK: ",
    "N10 ",
    "R1=R1+",
    "R[2]=",
    "DEF INT I=",
    "TRANS X",
    "AROT Z",
    "G41 G1 X",
    "G40 X",
    "CYCLE832(",
    "X=AC(",
];
const TARGETS: [&str; 6] = ["MARK", "N10", "1", "R1", "NOT I", ")"];

#[derive(Arbitrary, Debug)]
enum Value {
    Small(i8),
    Tenths(i16),
    Any(f64),
    Parameter(u8),
    Stored(u16),
    Named(u8),
    Expression(Box<Value>, u8, Box<Value>),
    Function(u8, Box<Value>),
}

#[derive(Arbitrary, Debug)]
enum Item {
    Code(u8),
    Word(u8, Value),
    Assign(u8, Value),
    AssignNamed(u8, Value),
    AssignStored(u16, Value),
    Comment,
}

#[derive(Arbitrary, Debug)]
enum Line {
    Words(Vec<Item>),
    Control(u8, u8, Vec<Value>),
    Location(u8, Vec<Value>),
    Order(u8, u8),
    Program(u8),
    Raw(String),
}

fn pick<'a>(list: &[&'a str], index: u8) -> &'a str {
    list[usize::from(index) % list.len()]
}

impl Value {
    fn write(&self, out: &mut String, depth: u32) {
        if depth > 20 {
            out.push('1');
            return;
        }
        let _ = match self {
            Self::Small(value) => write!(out, "{value}"),
            Self::Tenths(value) => write!(out, "{:.1}", f64::from(*value) / 10.0),
            Self::Any(value) => write!(out, "{value}"),
            Self::Parameter(number) => write!(out, "#{number}"),
            Self::Stored(number) => write!(out, "#{}", 5161 + number % 300),
            Self::Named(name) => write!(
                out,
                "#<{}n{}>",
                if name & 8 > 0 { "_" } else { "" },
                name % 4
            ),
            Self::Expression(left, operator, right) => {
                out.push('[');
                left.write(out, depth + 1);
                out.push_str(pick(&OPERATORS, *operator));
                right.write(out, depth + 1);
                write!(out, "]")
            }
            Self::Function(name, value) => {
                let name = pick(&FUNCTIONS, *name);
                let _ = write!(out, "{name}[");
                value.write(out, depth + 1);
                if name == "ATAN" {
                    write!(out, "]/[2]")
                } else {
                    write!(out, "]")
                }
            }
        };
    }
}

impl Line {
    fn write(&self, out: &mut String) {
        match self {
            Self::Words(items) => {
                for item in items {
                    item.write(out);
                    out.push(' ');
                }
            }
            Self::Control(label, keyword, values) => {
                let _ = write!(out, "o{} {}", label % 4, pick(&KEYWORDS, *keyword));
                for value in values {
                    out.push('[');
                    value.write(out, 0);
                    out.push(']');
                }
            }
            Self::Location(statement, values) => {
                out.push_str(pick(&STATEMENTS, *statement));
                for (index, value) in values.iter().enumerate() {
                    if index > 0 {
                        out.push(',');
                    }
                    value.write(out, 20);
                    if let Value::Tenths(tenths) = value {
                        let _ = write!(out, ".{}", tenths.unsigned_abs());
                    }
                }
            }
            Self::Order(order, target) => {
                out.push_str(pick(&ORDERS, *order));
                out.push_str(pick(&TARGETS, *target));
            }
            Self::Program(number) => {
                let _ = write!(out, "O{}", number % 4);
            }
            Self::Raw(text) => out.push_str(text),
        }
        out.push('\n');
    }
}

impl Item {
    fn write(&self, out: &mut String) {
        match self {
            Self::Code(code) => out.push_str(pick(&CODES, *code)),
            Self::Word(letter, value) => {
                out.push_str(pick(&LETTERS, *letter));
                value.write(out, 0);
            }
            Self::Assign(number, value) => {
                let _ = write!(out, "#{number}=");
                value.write(out, 0);
            }
            Self::AssignNamed(name, value) => {
                let _ = write!(out, "#<n{}>=", name % 4);
                value.write(out, 0);
            }
            Self::AssignStored(number, value) => {
                let _ = write!(out, "#{}=", 5161 + number % 300);
                value.write(out, 0);
            }
            Self::Comment => out.push_str("(c)"),
        }
    }
}

fuzz_target!(|lines: Vec<Line>| {
    let mut text = String::from("F100 S1\n");
    for line in &lines {
        line.write(&mut text);
    }
    toolglide_program_fuzz::read(text.as_bytes());
});
