# A program of 5 million moves of 0.03 to 0.09 mm along a smooth closed curve, for measuring.
BEGIN {
    print "G64 P0.01\nF6000"
    for (i = 1; i <= 5000000; i++)
        printf "G1 X%.4f Y%.4f\n", 50 * sin(i * 0.001), 50 * sin(i * 0.0015)
}
