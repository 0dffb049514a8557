// Empty: the target of this file owns a precompiled header that all test programs share.
