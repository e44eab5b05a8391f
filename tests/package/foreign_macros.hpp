// SPDX-License-Identifier: Zlib
//
// Words that are macros in other people's headers, as those define them. Where a program includes such
// a header before ours, none of our headers may use the word (tests/package/strict_users.cmake). Each
// stands once, on a line of its own, under whom it comes from.

// Qt without QT_NO_KEYWORDS.
#define slots
#define signals public
#define emit
#define foreach(variable, container) for (variable : container)
#define forever for (;;)

// X11: X.h, Xlib.h, Xutil.h. Eigen refuses its Success, so that Eigen has to come first.
#define Above 0
#define Always 2
#define Below 1
#define Bool int
#define Complex 0
#define Convex 2
#define CurrentTime 0L
#define CursorShape 0
#define Expose 12
#define False 0
#define FocusIn 9
#define FocusOut 10
#define KeyPress 2
#define KeyRelease 3
#define None 0L
#define NoValue 0
#define Nonconvex 1
#define NormalState 1
#define Opposite 4
#define Status int
#define True 1
#define TrueColor 4
#define Unsorted 0

// Windows without NOMINMAX, its structured exceptions, and COM.
#define min(a, b) (((a) < (b)) ? (a) : (b))
#define max(a, b) (((a) > (b)) ? (a) : (b))
#define near
#define far
#define small char
#define hyper __int64
#define leave __leave
#define interface struct
#define cdecl
#define pascal
#define ABSOLUTE 1
#define ALTERNATE 1
#define CALLBACK
#define CONST const
#define CreateFile CreateFileW
#define CreateWindow CreateWindowW
#define DELETE 0x00010000L
#define DIFFERENCE 11
#define DOMAIN 1
#define DrawText DrawTextW
#define ERROR 0
#define FALSE 0
#define FAR
#define FindText FindTextW
#define GetClassName GetClassNameW
#define GetCurrentTime() GetTickCount()
#define GetJob GetJobW
#define GetMessage GetMessageW
#define GetObject GetObjectW
#define GetProp GetPropW
#define IGNORE 0
#define IN
#define LoadImage LoadImageW
#define NEAR
#define NO_ERROR 0
#define OPAQUE 2
#define OPTIONAL
#define OUT
#define OVERFLOW 3
#define PlaySound PlaySoundW
#define RELATIVE 2
#define RGB(r, g, b) 0
#define SendMessage SendMessageW
#define SetPort SetPortW
#define STRICT 1
#define THIS void
#define TRANSPARENT 1
#define TRUE 1
#define UNDERFLOW 4
#define VOID void
#define Yield()

// Apple: AssertMacros.h and Objective-C.
#define check(assertion)
#define check_noerr(error)
#define nil nullptr
#define require(assertion, label)
#define require_noerr(error, label)
#define verify(assertion)
#define verify_noerr(error)
#define NO 0
#define YES 1

// The C library of Linux, and what GNU's dialects predefine.
#define I 1i
#define linux 1
#define major(device) gnu_dev_major(device)
#define minor(device) gnu_dev_minor(device)
#define makedev(major, minor) gnu_dev_makedev(major, minor)
#define unix 1
#define B0 0
#define ECHO 0000010
#define PAGE_SIZE 4096

// Unreal Engine, Godot, GLib, Arduino.
#define checkf(assertion, format)
#define ensure(assertion) (assertion)
#define PI 3.14159265358979323846f
#define TEXT(text) L##text
#define ABS(a) (a)
#define CLAMP(a, low, high) (a)
#define MAX(a, b) (a)
#define MIN(a, b) (a)
#define SIGN(a) (a)
#define SWAP(a, b)
#define constrain(amount, low, high) (amount)
#define degrees(angle) (angle)
#define radians(angle) (angle)
#define sq(x) ((x) * (x))
